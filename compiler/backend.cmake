# The back end: robot.json to a typed robot, tree and robot to a typed program, program to image.
# The library's files are embedded in the compiler, so that rsc works from any folder.
#   embed(FOLDER SUFFIX HEADER TYPE FUNCTION OUT): see embed_texts.cmake
function(embed folder suffix header type function out)
  set(script ${CMAKE_CURRENT_FUNCTION_LIST_DIR}/embed_texts.cmake)
  file(GLOB files CONFIGURE_DEPENDS ${folder}/*.${suffix})
  add_custom_command(
    OUTPUT ${out}
    COMMAND ${CMAKE_COMMAND} -DOUT=${out} -DFOLDER=${folder} -DSUFFIX=${suffix} -DHEADER=${header}
            -DTYPE=${type} -DFUNCTION=${function} -P ${script}
    DEPENDS ${files} ${script} ${PROJECT_SOURCE_DIR}/cmake/pack.cmake
    COMMENT "Embedding ${folder}/*.${suffix}"
    VERBATIM)
  set_source_files_properties(${out} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON COMPILE_OPTIONS
                              $<$<NOT:$<BOOL:${ROBOSYNC_SANITIZE}>>:-Oz>)
endfunction()
set(device_texts ${CMAKE_CURRENT_BINARY_DIR}/device_texts.cpp)
embed(${PROJECT_SOURCE_DIR}/stdlib/devices json compiler/config/devices.hpp DeviceText device_texts
      ${device_texts})
set(board_texts ${CMAKE_CURRENT_BINARY_DIR}/board_texts.cpp)
embed(${PROJECT_SOURCE_DIR}/stdlib/boards json compiler/config/boards.hpp BoardText board_texts
      ${board_texts})
set_source_files_properties(config/boards.cpp PROPERTIES COMPILE_DEFINITIONS ROBOSYNC_BOARD="${ROBOSYNC_BOARD}")
set(module_texts ${CMAKE_CURRENT_BINARY_DIR}/module_texts.cpp)
embed(${PROJECT_SOURCE_DIR}/stdlib rsl compiler/modules.hpp ModuleText module_texts
      ${module_texts})

target_sources(robosync_compiler_small PRIVATE
  compiler.cpp
  lints.cpp
  modules.cpp
  project.cpp
  reading.cpp
  codegen/code.cpp
  codegen/costly_rules.cpp
  codegen/emit.cpp
  codegen/expression_emitter.cpp
  codegen/operations.cpp
  codegen/records.cpp
  codegen/response_emitter.cpp
  codegen/rules.cpp
  codegen/tables.cpp
  codegen/verify_image.cpp
  config/actuators.cpp
  config/algorithms.cpp
  config/boards.cpp
  config/devices.cpp
  config/drive.cpp
  config/encoder.cpp
  config/entries.cpp
  config/fields.cpp
  config/json_format.cpp
  config/json_mistakes.cpp
  config/json_reader.cpp
  config/names.cpp
  config/panel.cpp
  config/pictures.cpp
  config/robot.cpp
  config/robot_reader.cpp
  config/robot_vocabulary.cpp
  config/sensors.cpp
  config/values.cpp
  config/wheel_encoders.cpp
  config/wiring.cpp
  config/wiring_limits.cpp
  optimize/expression_facts.cpp
  optimize/flow.cpp
  optimize/optimize.cpp
  optimize/prune.cpp
  optimize/room.cpp
  optimize/share.cpp
  optimize/simplify.cpp
  optimize/variable_facts.cpp
  sema/analyze.cpp
  sema/behaviors.cpp
  sema/commands.cpp
  sema/condition_lints.cpp
  sema/conditions.cpp
  sema/defines.cpp
  sema/expressions.cpp
  sema/follow.cpp
  sema/functions.cpp
  sema/intervals.cpp
  sema/limits.cpp
  sema/lints.cpp
  sema/lists.cpp
  sema/misread.cpp
  sema/motions.cpp
  sema/number_lists.cpp
  sema/perform.cpp
  sema/quantities.cpp
  sema/rules.cpp
  sema/statements.cpp
  sema/texts.cpp
  sema/timers.cpp
  sema/unknown_names.cpp
  sema/unknown_verbs.cpp
  sema/variables.cpp
  sema/waiting_commands.cpp
  sema/whole_commands.cpp
  source/sorting.cpp
  units/units.cpp)
target_link_libraries(robosync_compiler_small PRIVATE nlohmann_json::nlohmann_json)
target_sources(robosync_compiler PRIVATE
  ${board_texts}
  ${device_texts}
  ${module_texts}
  ir/expression.cpp
  ir/fact.cpp
  ir/program.cpp
  sema/names.cpp)
target_link_libraries(robosync_compiler PRIVATE nlohmann_json::nlohmann_json)
