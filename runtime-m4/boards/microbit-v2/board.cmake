# The board's sources, linker script and clock, and QEMU's name for it (boards/common/firmware.cmake).
set(board_sources board.cpp alarm.cpp analog.cpp buses.cpp clock.cpp echoes.cpp flash.cpp i2c.cpp inputs.cpp lights.cpp logo.cpp microphone.cpp panel.cpp pins.cpp player.cpp resets.cpp speaker.cpp spi.cpp thermometer.cpp ../common/bus_requests.cpp)
set(board_fast buses.cpp i2c.cpp ../common/bus_requests.cpp)
set(board_script microbit_v2.ld)
set(board_machine microbit)
set(board_clock ROBOSYNC_CLOCK_IS_CALLED ROBOSYNC_CORE_COUNTS=4)
set(board_code ROBOSYNC_CODE_BITS=23)  # up to 0x0080'0000, where the chip shows its RAM a second time
