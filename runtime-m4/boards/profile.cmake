# What the profile of the board (stdlib/boards/NAME.json) says of its memory, for boards/memory.hpp and the linker.
set(board_profile ${PROJECT_SOURCE_DIR}/stdlib/boards/${ROBOSYNC_BOARD}.json)
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${board_profile})
file(READ ${board_profile} profile)
string(JSON arena_begin GET "${profile}" arena begin)
string(JSON arena_bytes GET "${profile}" arena bytes)
string(JSON step_budget GET "${profile}" step_budget)
set(board_memory
  ROBOSYNC_ARENA_BEGIN=${arena_begin} ROBOSYNC_ARENA_BYTES=${arena_bytes} ROBOSYNC_STEP_BUDGET=${step_budget})
