# What the compiler tells people: programs and diagnostics in plain English, TEST blocks, and what editors ask.
find_package(fmt REQUIRED)
target_sources(robosync_compiler PRIVATE
  explain/actuators.cpp
  explain/codes.cpp
  explain/conditions.cpp
  explain/program_text.cpp
  explain/rules.cpp
  explain/statements.cpp
  query/collector.cpp
  query/completion.cpp
  query/describe.cpp
  query/expected.cpp
  query/outline.cpp
  query/rename.cpp
  query/symbols.cpp
  query/tokens.cpp
  query/walk.cpp
  test_plan/evaluate.cpp
  test_plan/plan.cpp)
target_link_libraries(robosync_compiler PRIVATE fmt::fmt)
# TESTs are planned once before they run and looked at once when they have, names are changed when an editor asks: small
# code is worth more there.
if(NOT ROBOSYNC_SANITIZE)
  set_source_files_properties(
    query/rename.cpp query/walk.cpp test_plan/evaluate.cpp test_plan/plan.cpp
    PROPERTIES COMPILE_OPTIONS -Os SKIP_UNITY_BUILD_INCLUSION ON)
endif()
