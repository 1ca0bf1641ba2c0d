# The back end: robot.json to a typed robot, tree and robot to a typed program, program to image.
find_package(PkgConfig REQUIRED)
pkg_check_modules(SODIUM REQUIRED IMPORTED_TARGET libsodium)  # SHA-256

# The device descriptors travel inside the library, so that rsc works from any folder.
set(device_folder ${PROJECT_SOURCE_DIR}/stdlib/devices)
set(device_texts ${CMAKE_CURRENT_BINARY_DIR}/device_texts.cpp)
set(embed_script ${CMAKE_CURRENT_LIST_DIR}/config/embed_devices.cmake)
file(GLOB device_files CONFIGURE_DEPENDS ${device_folder}/*.json)
add_custom_command(
  OUTPUT ${device_texts}
  COMMAND ${CMAKE_COMMAND} -DOUT=${device_texts} -DFOLDER=${device_folder} -P ${embed_script}
  DEPENDS ${device_files} ${embed_script}
  COMMENT "Embedding the device descriptors"
  VERBATIM)

# So do the modules of the library.
set(module_folder ${PROJECT_SOURCE_DIR}/stdlib)
set(module_texts ${CMAKE_CURRENT_BINARY_DIR}/module_texts.cpp)
set(embed_modules ${CMAKE_CURRENT_LIST_DIR}/embed_modules.cmake)
file(GLOB module_files CONFIGURE_DEPENDS ${module_folder}/*.rsl)
add_custom_command(
  OUTPUT ${module_texts}
  COMMAND ${CMAKE_COMMAND} -DOUT=${module_texts} -DFOLDER=${module_folder} -P ${embed_modules}
  DEPENDS ${module_files} ${embed_modules}
  COMMENT "Embedding the modules of the library"
  VERBATIM)

target_sources(robosync_compiler PRIVATE
  compiler.cpp
  modules.cpp
  ${device_texts}
  ${module_texts}
  config/actuators.cpp
  config/channels.cpp
  config/devices.cpp
  config/entries.cpp
  config/fields.cpp
  config/json_mistake.cpp
  config/json_reader.cpp
  config/names.cpp
  config/robot.cpp
  config/robot_reader.cpp
  config/sections.cpp
  config/sensors.cpp
  config/units.cpp
  config/values.cpp
  config/wiring.cpp
  sema/amounts.cpp
  sema/analyze.cpp
  sema/arguments.cpp
  sema/arithmetic.cpp
  sema/behaviors.cpp
  sema/calls.cpp
  sema/checks.cpp
  sema/commands.cpp
  sema/compute.cpp
  sema/declarations.cpp
  sema/expressions.cpp
  sema/flow.cpp
  sema/implication.cpp
  sema/labels.cpp
  sema/limits.cpp
  sema/lint_bands.cpp
  sema/lint_conditions.cpp
  sema/lint_names.cpp
  sema/lint_robot.cpp
  sema/lint_rules.cpp
  sema/lint_waits.cpp
  sema/names.cpp
  sema/program.cpp
  sema/quantities.cpp
  sema/rules.cpp
  sema/settings.cpp
  sema/statements.cpp
  sema/texts.cpp
  sema/time_words.cpp
  sema/variables.cpp
  optimize/expression_facts.cpp
  optimize/fact.cpp
  optimize/flow.cpp
  optimize/flow_loops.cpp
  optimize/optimize.cpp
  optimize/prune.cpp
  optimize/share.cpp
  optimize/simplify.cpp
  optimize/variable_facts.cpp
  codegen/code_draft.cpp
  codegen/code_pool.cpp
  codegen/dearest_rules.cpp
  codegen/expression_emitter.cpp
  codegen/frame.cpp
  codegen/image_writer.cpp
  codegen/operations.cpp
  codegen/records.cpp
  codegen/response_blocks.cpp
  codegen/response_emitter.cpp
  codegen/rules.cpp
  codegen/strings.cpp
  codegen/tables.cpp
  codegen/timers.cpp)
target_link_libraries(robosync_compiler PRIVATE PkgConfig::SODIUM nlohmann_json::nlohmann_json)
