# The compiler's output for people: programs and diagnostics in plain English, TEST blocks, and answers to editors.
find_package(fmt REQUIRED)
target_sources(robosync_compiler_small PRIVATE
  explain/actuators.cpp
  explain/codes.cpp
  explain/conditions.cpp
  explain/program_text.cpp
  explain/rules.cpp
  explain/statements.cpp
  query/completion.cpp
  query/configuration.cpp
  query/configuration_hover.cpp
  query/configuration_outline.cpp
  query/configuration_scan.cpp
  query/describe.cpp
  query/expected.cpp
  query/outline.cpp
  query/rename.cpp
  query/symbols.cpp
  query/walk.cpp
  test_plan/evaluate.cpp
  test_plan/plan.cpp)
target_link_libraries(robosync_compiler_small PRIVATE fmt::fmt)

set(key_texts ${CMAKE_CURRENT_BINARY_DIR}/key_texts.cpp)
set(schema ${PROJECT_SOURCE_DIR}/grammar/robot.schema.json)
add_custom_command(
  OUTPUT ${key_texts}
  COMMAND ${CMAKE_COMMAND} -DOUT=${key_texts} -DSCHEMA=${schema} -P ${CMAKE_CURRENT_LIST_DIR}/embed_keys.cmake
  DEPENDS ${schema} ${CMAKE_CURRENT_LIST_DIR}/embed_keys.cmake ${PROJECT_SOURCE_DIR}/cmake/pack.cmake
  COMMENT "Embedding what the schema says of the keys of robot.json"
  VERBATIM)
set_source_files_properties(${key_texts} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
target_sources(robosync_compiler PRIVATE
  ${key_texts}
  query/collector.cpp
  query/tokens.cpp)
target_link_libraries(robosync_compiler PRIVATE fmt::fmt)
