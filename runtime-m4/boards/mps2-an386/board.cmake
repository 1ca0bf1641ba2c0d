# The board's sources and linker script, and QEMU's name for it (boards/common/firmware.cmake).
set(board_sources board.cpp i2c.cpp spi.cpp alarm.cpp)
set(board_script mps2_an386.ld)
set(board_machine mps2-an386)
