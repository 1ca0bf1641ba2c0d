# What the profile of the board (stdlib/boards/NAME.json) says of its memory and its pins, for boards/memory.hpp,
# boards/pins.hpp and the linker.
set(board_profile ${PROJECT_SOURCE_DIR}/stdlib/boards/${ROBOSYNC_BOARD}.json)
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${board_profile})
file(READ ${board_profile} profile)
string(JSON arena_begin GET "${profile}" arena begin)
string(JSON arena_bytes GET "${profile}" arena bytes)
string(JSON step_budget GET "${profile}" step_budget)
string(JSON i2c_buses GET "${profile}" i2c_buses)
# {first pin, last, shortest pulse, longest, µs per ms}, as policy::PinLimit has them.
string(JSON count LENGTH "${profile}" outputs)
math(EXPR last "${count} - 1")
set(board_outputs "")
foreach(i RANGE ${last})
  string(JSON first GET "${profile}" outputs ${i} pins 0)
  string(JSON final GET "${profile}" outputs ${i} pins 1)
  string(JSON shortest GET "${profile}" outputs ${i} pulse_us 0)
  string(JSON longest GET "${profile}" outputs ${i} pulse_us 1)
  string(JSON rise ERROR_VARIABLE any GET "${profile}" outputs ${i} us_per_ms)
  if(any)
    set(rise 0)
  endif()
  string(APPEND board_outputs "{${first},${final},${shortest},${longest},${rise}},")
endforeach()
set(board_definitions
  ROBOSYNC_ARENA_BEGIN=${arena_begin} ROBOSYNC_ARENA_BYTES=${arena_bytes} ROBOSYNC_STEP_BUDGET=${step_budget}
  ROBOSYNC_I2C_BUSES=${i2c_buses} ROBOSYNC_OUTPUTS=${board_outputs})
