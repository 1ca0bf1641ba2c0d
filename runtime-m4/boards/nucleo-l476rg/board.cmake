# The board's chip, and QEMU's substitute: another board with a chip of this family, whose second serial line is USART2
# (boards/common/firmware.cmake).
include(boards/stm32l4/stm32l4.cmake)
set(board_machine b-l475e-iot01a)
set(board_line 1)
