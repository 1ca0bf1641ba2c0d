# Sources, linker script and clock of the board, and how QEMU calls it (boards/common/firmware.cmake).
set(board_sources board.cpp analog.cpp clock.cpp echoes.cpp flash.cpp i2c.cpp inputs.cpp panel.cpp pins.cpp)
set(board_script b_l475e_iot01a.ld)
set(board_machine b-l475e-iot01a)
set(board_clock ROBOSYNC_CLOCK_IS_SYSTICK)
