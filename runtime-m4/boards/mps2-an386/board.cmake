# The board's sources and linker script, and QEMU's name for it (boards/common/firmware.cmake).
set(board_sources board.cpp buses.cpp i2c.cpp spi.cpp alarm.cpp ../common/bus_requests.cpp)
set(board_fast buses.cpp i2c.cpp ../common/bus_requests.cpp)
set(board_script mps2_an386.ld)
set(board_machine mps2-an386)
set(board_idle ON)
set(board_requests 11)
