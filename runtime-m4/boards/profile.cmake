# Reads the board's memory and pins from its profile (stdlib/boards/NAME.json), for boards/memory.hpp, boards/pins.hpp and the
# linker.
set(board_profile ${PROJECT_SOURCE_DIR}/stdlib/boards/${ROBOSYNC_BOARD}.json)
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${board_profile})
file(READ ${board_profile} profile)
string(JSON arena_begin GET "${profile}" arena begin)
string(JSON arena_bytes GET "${profile}" arena bytes)
string(JSON step_budget GET "${profile}" step_budget)
string(JSON i2c_buses GET "${profile}" i2c_buses)
string(JSON serial_lines GET "${profile}" serial_lines)
string(JSON spi_buses GET "${profile}" spi_buses)
string(JSON player_pin ERROR_VARIABLE any GET "${profile}" player_pin)
if(any)
  set(player_pin 0xFFFF)
endif()
string(JSON store_bytes ERROR_VARIABLE any GET "${profile}" store)
if(any)
  set(store_bytes 0)
endif()
# rows(KIND FIELD…): KIND is an array of the profile; sets board_KIND to its rows, with these fields, and KIND_rows to how many
# there are. A field is a path with points; ?FIELD is 0 where it is missing.
function(rows kind)
  string(JSON count ERROR_VARIABLE none LENGTH "${profile}" ${kind})
  if(none)
    set(count 0)
  endif()
  set(rows "")
  set(i 0)
  while(i LESS count)
    set(values "")
    foreach(field ${ARGN})
      string(REGEX MATCHALL "[^.?]+" path "${field}")
      string(JSON value ERROR_VARIABLE missing GET "${profile}" ${kind} ${i} ${path})
      if(missing AND field MATCHES "^[?]")
        set(value 0)
      elseif(missing)
        message(FATAL_ERROR "${board_profile}: ${kind}: ${missing}")
      endif()
      string(APPEND values "${value},")
    endforeach()
    string(APPEND rows "{${values}},")
    math(EXPR i "${i} + 1")
  endwhile()
  set(board_${kind} "${rows}" PARENT_SCOPE)
  set(${kind}_rows ${count} PARENT_SCOPE)
endfunction()
rows(outputs pins.0 pins.1 pulse_us.0 pulse_us.1 ?us_per_ms)  # policy::PinLimit
foreach(kind inputs echoes analog enables panels spi_pins selects)
  rows(${kind} pins.0 pins.1)  # policy::PinRange
endforeach()
# Every input can be that of an echo, unless the profile says which.
if(echoes_rows EQUAL 0)
  set(board_echoes "${board_inputs}")
endif()
rows(reserved bus address)  # policy::I2cPlace
# The host has every part that any board has.
if(panels_rows EQUAL 0 AND NOT CMAKE_CROSSCOMPILING)
  set(panels_rows 1)
  set(board_panels "{0,65535},")
endif()
foreach(part lights speaker microphone parts)
  string(JSON ${part} ERROR_VARIABLE none GET "${profile}" ${part})
  set(board_${part} 1)
  if(none AND CMAKE_CROSSCOMPILING)
    set(board_${part} 0)
  endif()
endforeach()
set(panels ${panels_rows})
# runtime_definitions are for portable code (boards/features.hpp); board_definitions for the board's code and for main.cpp.
set(runtime_definitions ROBOSYNC_LIGHTS=${board_lights} ROBOSYNC_SPEAKER=${board_speaker}
  ROBOSYNC_MICROPHONE=${board_microphone} ROBOSYNC_PARTS=${board_parts})
foreach(feature I2C_BUSES SPI_BUSES SERIAL_LINES PANELS)
  set(has 0)
  string(TOLOWER ${feature} what)
  if(${what} GREATER 0)
    set(has 1)
  endif()
  list(APPEND runtime_definitions ROBOSYNC_HAS_${feature}=${has})
endforeach()
set(board_definitions
  ROBOSYNC_ARENA_BEGIN=${arena_begin} ROBOSYNC_ARENA_BYTES=${arena_bytes} ROBOSYNC_STEP_BUDGET=${step_budget}
  ROBOSYNC_I2C_BUSES=${i2c_buses} ROBOSYNC_SPI_BUSES=${spi_buses} ROBOSYNC_STORE_BYTES=${store_bytes} ROBOSYNC_OUTPUTS=${board_outputs}
  ROBOSYNC_INPUTS=${board_inputs} ROBOSYNC_ECHOES=${board_echoes} ROBOSYNC_ANALOG=${board_analog} ROBOSYNC_ANALOG_ROWS=${analog_rows}
  ROBOSYNC_ENABLES=${board_enables} ROBOSYNC_ENABLE_ROWS=${enables_rows}
  ROBOSYNC_SPI_PINS=${board_spi_pins} ROBOSYNC_SPI_PIN_ROWS=${spi_pins_rows} ROBOSYNC_SELECTS=${board_selects} ROBOSYNC_SELECT_ROWS=${selects_rows}
  ROBOSYNC_PLAYER_PIN=${player_pin}
  ROBOSYNC_PANELS=${board_panels} ROBOSYNC_PANEL_ROWS=${panels_rows}
  ROBOSYNC_RESERVED=${board_reserved} ROBOSYNC_RESERVED_ROWS=${reserved_rows} ROBOSYNC_SERIAL_LINES=${serial_lines})
