# Sources, linker script and memory of the board, and how QEMU calls it (boards/common/firmware.cmake).
set(board_sources board.cpp i2c.cpp alarm.cpp)
set(board_script mps2_an386.ld)
set(board_machine mps2-an386)
