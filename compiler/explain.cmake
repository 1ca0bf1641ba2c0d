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
  query/describe.cpp
  query/outline.cpp
  query/rename.cpp
  query/walk.cpp
  test_plan/evaluate.cpp
  test_plan/plan.cpp)
target_link_libraries(robosync_compiler_small PRIVATE fmt::fmt)
target_sources(robosync_compiler PRIVATE
  query/collector.cpp
  query/expected.cpp
  query/symbols.cpp
  query/tokens.cpp)
target_link_libraries(robosync_compiler PRIVATE fmt::fmt)
