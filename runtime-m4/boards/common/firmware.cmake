# The firmware for the board that the preset names (ROBOSYNC_BOARD): boards/NAME/board.cmake says what is special to it.
#
#   board_sources   the board's own sources, in boards/NAME/
#   board_script    its linker script, which includes firmware.ld
#   board_machine   what QEMU calls the board (build/…/machine, for scripts and tests)
#   board_clock     when no load reads a free-running counter of 32 bits: ROBOSYNC_CLOCK_IS_SYSTICK where there is none,
#                   or ROBOSYNC_CLOCK_IS_CALLED (port/cortex-m4/clock.hpp)
list(TRANSFORM board_sources PREPEND boards/${ROBOSYNC_BOARD}/)
file(WRITE ${PROJECT_BINARY_DIR}/machine "${board_machine}\n")

# Shared by the firmware and by the tests and benches on the board; brings the linker script.
set(board_common ${CMAKE_CURRENT_LIST_DIR})
set(board_script ${CMAKE_CURRENT_SOURCE_DIR}/boards/${ROBOSYNC_BOARD}/${board_script})
add_library(robosync_board OBJECT
  boards/common/startup.cpp boards/common/reset.cpp boards/common/costs.cpp boards/common/vectors.cpp ${board_sources})
set_source_files_properties(boards/common/costs.cpp PROPERTIES
  COMPILE_DEFINITIONS ROBOSYNC_BOARD_COSTS="runtime-m4/boards/${ROBOSYNC_BOARD}/costs.def")
set_source_files_properties(boards/common/vectors.cpp PROPERTIES
  COMPILE_DEFINITIONS ROBOSYNC_BOARD_INTERRUPTS="runtime-m4/boards/${ROBOSYNC_BOARD}/interrupts.hpp")
target_link_libraries(robosync_board PUBLIC robosync_runtime)
robosync_variant(robosync_board asserted ROBOSYNC_ASSERTIONS)
target_link_libraries(robosync_board_asserted PUBLIC robosync_runtime_asserted)
foreach(board robosync_board robosync_board_asserted)
  target_link_options(${board} INTERFACE -L${board_common} -T${board_script}
    -Wl,--defsym=arena_begin=${arena_begin},--defsym=arena_bytes=${arena_bytes},--defsym=store_bytes=${store_bytes})
  set_property(TARGET ${board} PROPERTY INTERFACE_LINK_DEPENDS ${board_script} ${board_common}/firmware.ld)
endforeach()

# robosync_elf(TARGET NAME SOURCES…): an ELF for this board, build/…/NAME.elf. When the name of TARGET ends in that of a
# variant, with the libraries of that one.
#
# Linked as C, without the C++ library, and without a heap: newlib's malloc would need _sbrk, which
# nobody defines, so code that allocates does not link.
function(robosync_elf target name)
  string(REGEX MATCH "_(asserted)$" variant ${target})
  add_executable(${target} ${ARGN})
  target_link_libraries(${target} PRIVATE robosync_board${variant} robosync_runtime${variant})
  target_link_options(${target} PRIVATE
    -flto -Os -nostartfiles --specs=nano.specs -Wl,--gc-sections -Wl,--print-memory-usage
    -Wl,--fatal-warnings -Wl,--no-warn-rwx-segments -Wl,-Map=${PROJECT_BINARY_DIR}/${name}.map)
  set_target_properties(${target} PROPERTIES
    LINKER_LANGUAGE C OUTPUT_NAME ${name} SUFFIX .elf RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR})
endfunction()

robosync_elf(robosync_firmware robosync boards/common/main.cpp)
