# The board's own code, shared by the firmware and by the kernel's tests on the board.
add_library(robosync_board OBJECT
  boards/mps2-an386/startup.cpp boards/mps2-an386/board.cpp boards/mps2-an386/uart.cpp
  boards/mps2-an386/i2c.cpp boards/mps2-an386/alarm.cpp)
target_link_libraries(robosync_board PUBLIC robosync_runtime)
robosync_large(robosync_board)
target_link_libraries(robosync_board_large PUBLIC robosync_runtime_large)

# robosync_elf(TARGET NAME SOURCES…): an ELF for this board, build/…/NAME.elf. With the libraries of the large
# profile when the name of TARGET ends in _large.
#
# Linked as C, without the C++ library, and without a heap: newlib's malloc would need _sbrk, which
# nobody defines, so code that allocates does not link.
function(robosync_elf target name)
  set(script ${PROJECT_SOURCE_DIR}/runtime-m4/boards/mps2-an386/mps2_an386.ld)
  string(REGEX MATCH "_large$" large ${target})
  add_executable(${target} ${ARGN})
  target_link_libraries(${target} PRIVATE robosync_board${large} robosync_runtime${large})
  target_link_options(${target} PRIVATE
    -flto -Os -nostartfiles --specs=nano.specs -T${script} -Wl,--gc-sections -Wl,--print-memory-usage
    -Wl,--fatal-warnings -Wl,-Map=${PROJECT_BINARY_DIR}/${name}.map)
  set_target_properties(${target} PROPERTIES
    LINKER_LANGUAGE C LINK_DEPENDS ${script}
    OUTPUT_NAME ${name} SUFFIX .elf RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR})
endfunction()

if(EXISTS ${CMAKE_CURRENT_SOURCE_DIR}/boards/mps2-an386/main.cpp)
  robosync_elf(robosync_firmware robosync-mps2-an386 boards/mps2-an386/main.cpp)
  robosync_elf(robosync_firmware_large robosync-large-mps2-an386 boards/mps2-an386/main.cpp)
  # The board has 4 MB of each.
  target_link_options(robosync_firmware_large PRIVATE -Wl,--defsym=flash_bytes=64K,--defsym=ram_bytes=512K)
endif()
include(${PROJECT_SOURCE_DIR}/tests/runtime-m4/kernel/firmware/firmware.cmake)
