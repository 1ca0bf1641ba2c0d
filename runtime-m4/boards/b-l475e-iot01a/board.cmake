# The board's chip, and QEMU's name for the board (boards/common/firmware.cmake).
include(boards/stm32l4/stm32l4.cmake)
set(board_machine b-l475e-iot01a)
