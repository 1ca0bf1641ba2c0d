# Settings of all boards with this chip: their board.cmake includes this, and each board has its own wiring.hpp
# (boards/common/firmware.cmake).
set(board_folder stm32l4)
set(board_sources board.cpp analog.cpp buses.cpp clock.cpp echoes.cpp flash.cpp i2c.cpp inputs.cpp panel.cpp pins.cpp spi.cpp ../common/bus_requests.cpp)
set(board_fast buses.cpp i2c.cpp ../common/bus_requests.cpp)
set(board_script stm32l47x.ld)
set(board_clock ROBOSYNC_CLOCK_IS_SYSTICK)
