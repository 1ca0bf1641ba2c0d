# Writes what the schema of robot.json says of its keys into one C++ file:
#   cmake -DOUT=FILE -DSCHEMA=robot.schema.json -P embed_keys.cmake
# After a line with the name of an object, @OBJECT, a line for each of its keys: KEY|value|meaning. The value is in words, or the name of
# a kind of values, which has a line of its own: $NAME|words. compiler/query/configuration_hover.cpp reads them.
cmake_minimum_required(VERSION 3.22)
file(READ ${SCHEMA} schema)
set(lines "\n")

# What stands at a path of the schema; empty: nothing.
macro(get out)
  string(JSON ${out} ERROR_VARIABLE missing GET "${schema}" ${ARGN})
  if(missing)
    set(${out} "")
  endif()
endmacro()

# The strings of a list in JSON, with commas.
function(strings_in list out)
  string(JSON count LENGTH "${list}")
  math(EXPR last "${count} - 1")
  set(strings "")
  foreach(i RANGE ${last})
    string(JSON string GET "${list}" ${i})
    if(string STREQUAL "")
      set(string "\"\"")
    endif()
    list(APPEND strings "${string}")
  endforeach()
  list(JOIN strings ", " strings)
  set(${out} "${strings}" PARENT_SCOPE)
endfunction()

# The value of the key at a path, whose kind is `of` if the schema defines it elsewhere.
function(value_of key of out)
  get(type ${ARGN} type)
  get(choices ${ARGN} enum)
  get(defined definitions "${of}" type)
  if(choices STREQUAL "")
    get(choices definitions "${of}" enum)
  endif()
  set(value_object "an object")
  set(value_array "a list")
  set(value_string "a string")
  set(value_boolean "true or false")
  set(value_integer "a whole number")
  # Completion lists these.
  if(key MATCHES "^(board|device|type)$")
    set(value "a string")
  elseif(choices)
    strings_in("${choices}" value)
  elseif(type)
    set(value "${value_${type}}")
  elseif(defined STREQUAL "object")
    set(value "an object")
  else()
    set(value "$${of}")
  endif()
  set(${out} "${value}" PARENT_SCOPE)
endfunction()

# The keys of an object, whose `properties` are at a path.
function(add_keys object)
  string(JSON count LENGTH "${schema}" ${ARGN})
  math(EXPR last "${count} - 1")
  string(APPEND lines "@${object}\n")
  foreach(i RANGE ${last})
    string(JSON key MEMBER "${schema}" ${ARGN} ${i})
    set(of "")
    foreach(place "$ref" "allOf;0;$ref")
      get(found ${ARGN} ${key} ${place})
      string(REGEX REPLACE ".*/" "" found "${found}")
      string(APPEND of "${found}")
    endforeach()
    value_of(${key} "${of}" value ${ARGN} ${key})
    get(meaning ${ARGN} ${key} description)
    if(meaning STREQUAL "")
      get(meaning definitions "${of}" description)
    endif()
    string(APPEND lines "${key}|${value}|${meaning}\n")
  endforeach()
  set(lines "${lines}" PARENT_SCOPE)
endfunction()

# In the order of enum Object (compiler/config/fields.hpp).
add_keys(robot properties)
foreach(object sensor channel actuator)
  add_keys(${object} definitions ${object} properties)
endforeach()
add_keys(trim definitions actuator properties trim properties)
foreach(object sound limits behavior scheduler safety algorithm)
  add_keys(${object} definitions ${object} properties)
endforeach()
foreach(kind quantity range whole)
  string(JSON words GET "${schema}" definitions ${kind} description)
  string(APPEND lines "$${kind}|${words}\n")
endforeach()

include(${CMAKE_CURRENT_LIST_DIR}/../cmake/pack.cmake)
embed(piece "${lines}")
pack(packed)
file(WRITE ${OUT} "// Made from ${SCHEMA} by compiler/embed_keys.cmake.
#include \"compiler/query/configuration.hpp\"
#include \"compiler/source/embedded.hpp\"

namespace robosync::compiler::query {

namespace {

${packed}
}  // namespace

std::string_view key_texts() {
  return all_texts();
}

}  // namespace robosync::compiler::query
")
