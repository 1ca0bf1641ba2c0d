# The firmware for the board that the preset names (ROBOSYNC_BOARD), and for its twins. boards/NAME/board.cmake sets what differs
# between boards:
#
#   board_folder    folder in boards/ with its sources, linker script and interrupts.hpp: a chip's; default: NAME
#   board_sources   the board's own sources there; if they depend on the chip's wiring, boards/NAME/wiring.hpp describes it
#   board_fast      those of them that are compiled for speed, together
#   board_script    its linker script, which includes firmware.ld
#   board_machine   QEMU's name of the board (build/…/machine, for scripts and tests)
#   board_line      the serial line of that machine that is the link's; default: 0 (build/…/line)
#   board_clock     if no load can read a free-running 32-bit counter: ROBOSYNC_CLOCK_IS_SYSTICK if there is none,
#                   or ROBOSYNC_CLOCK_IS_CALLED (port/cortex-m4/clock.hpp)
#   board_code      ROBOSYNC_CODE_BITS=n if behaviours may read only the first 2^n bytes of the code region (port/cortex-m4/isolation.cpp)
#   board_idle      ON if the idle thread sometimes has work instead of sleeping (port/cortex-m4/hooks.hpp)
#   board_requests  how many requests an I2C bus keeps (boards/common/bus_requests.hpp); default: 20
set(board_common ${CMAKE_CURRENT_LIST_DIR})

# Options for compiling the board's sources and for linking with them. The firmware, the board's tests and its benches share
# them.
function(robosync_wire_board target)
  set(script ${CMAKE_CURRENT_SOURCE_DIR}/boards/${board_folder}/${board_script})
  target_compile_definitions(${target} PUBLIC ${board_definitions} ROBOSYNC_BUS_REQUESTS=${board_requests} PRIVATE
    ROBOSYNC_BOARD_COSTS="runtime-m4/boards/${ROBOSYNC_BOARD}/costs.def"
    ROBOSYNC_BOARD_WIRING="runtime-m4/boards/${ROBOSYNC_BOARD}/wiring.hpp"
    ROBOSYNC_BOARD_INTERRUPTS="runtime-m4/boards/${board_folder}/interrupts.hpp")
  target_link_options(${target} INTERFACE -L${board_common} -T${script}
    -Wl,--defsym=arena_begin=${arena_begin},--defsym=arena_bytes=${arena_bytes},--defsym=store_bytes=${store_bytes})
  set_property(TARGET ${target} PROPERTY INTERFACE_LINK_DEPENDS ${script} ${board_common}/firmware.ld)
endfunction()

# Calls between these files are inlined. The compiler must not turn loops over a few bytes into calls.
function(robosync_hurry folder)
  list(TRANSFORM ARGN PREPEND boards/${folder}/)
  set_source_files_properties(${ARGN} PROPERTIES COMPILE_OPTIONS "-O2;-fno-tree-loop-distribute-patterns;-flto;-ffat-lto-objects")
endfunction()

# robosync_board(TARGET FOLDER): the objects of the board that profile.cmake and board.cmake describe. FOLDER gets the firmware
# and the files about the machine that scripts and tests read.
function(robosync_board target folder)
  if(NOT board_folder)
    set(board_folder ${ROBOSYNC_BOARD})
  endif()
  if(NOT board_line)
    set(board_line 0)
  endif()
  if(NOT board_requests)
    set(board_requests 20)
  endif()
  file(WRITE ${folder}/machine "${board_machine}\n")
  file(WRITE ${folder}/line "${board_line}\n")
  list(TRANSFORM board_sources PREPEND boards/${board_folder}/)
  robosync_hurry(${board_folder} ${board_fast})
  add_library(${target} OBJECT
    boards/common/startup.cpp boards/common/reset.cpp boards/common/costs.cpp boards/common/vectors.cpp ${board_sources})
  target_link_libraries(${target} PUBLIC robosync_runtime)
  robosync_wire_board(${target})
  robosync_variant(${target} asserted ROBOSYNC_ASSERTIONS)
  target_link_libraries(${target}_asserted PUBLIC robosync_runtime_asserted)
  robosync_wire_board(${target}_asserted)
endfunction()

# Linked as C, without the C++ library, and without a heap: newlib's malloc needs _sbrk, which is not
# defined, so code that allocates does not link.
function(robosync_link target folder name board runtime)
  add_executable(${target} ${ARGN})
  target_link_libraries(${target} PRIVATE ${board} ${runtime})
  target_link_options(${target} PRIVATE
    -flto -Os -nostartfiles --specs=nano.specs -Wl,--gc-sections -Wl,--print-memory-usage
    -Wl,--fatal-warnings -Wl,--no-warn-rwx-segments -Wl,-Map=${folder}/${name}.map)
  set_target_properties(${target} PROPERTIES
    LINKER_LANGUAGE C OUTPUT_NAME ${name} SUFFIX .elf RUNTIME_OUTPUT_DIRECTORY ${folder})
endfunction()

# robosync_elf(TARGET NAME SOURCES…): an ELF for the board, build/…/NAME.elf. If TARGET ends in the name of a variant, it is
# linked with that variant's libraries.
function(robosync_elf target name)
  string(REGEX MATCH "_(asserted)$" variant ${target})
  robosync_link(${target} ${PROJECT_BINARY_DIR} ${name} robosync_board${variant} robosync_runtime${variant} ${ARGN})
endfunction()

robosync_board(robosync_board ${PROJECT_BINARY_DIR})
robosync_elf(robosync_firmware robosync boards/common/main.cpp)

# Another board that shares the runtime's objects, so that they need not be compiled twice: both profiles give the same
# runtime_definitions, and both board.cmake the same clock. Its firmware is build/…/BOARD/robosync.elf.
function(robosync_twin ROBOSYNC_BOARD)
  unset(board_folder)
  unset(board_line)
  unset(board_fast)
  include(boards/profile.cmake)
  include(boards/${ROBOSYNC_BOARD}/board.cmake)
  list(APPEND runtime_definitions ${board_clock} ${board_code})
  if(NOT runtime_definitions STREQUAL features)
    message(FATAL_ERROR "${ROBOSYNC_BOARD} is no twin: its runtime is compiled with ${runtime_definitions}, not ${features}")
  endif()
  set(folder ${PROJECT_BINARY_DIR}/${ROBOSYNC_BOARD})
  robosync_board(robosync_board_${ROBOSYNC_BOARD} ${folder})
  robosync_link(robosync_firmware_${ROBOSYNC_BOARD} ${folder} robosync robosync_board_${ROBOSYNC_BOARD} robosync_runtime
                boards/common/main.cpp)
endfunction()

foreach(twin ${ROBOSYNC_TWINS})
  robosync_twin(${twin})
endforeach()
