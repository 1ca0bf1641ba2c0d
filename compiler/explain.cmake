# What the compiler tells people: programs and diagnostics in plain English, and TEST blocks.
find_package(fmt REQUIRED)
target_sources(robosync_compiler PRIVATE
  explain/actuators.cpp
  explain/codes.cpp
  explain/conditions.cpp
  explain/program_text.cpp
  explain/rules.cpp
  explain/statements.cpp
  testing/evaluate.cpp
  testing/plan.cpp)
target_link_libraries(robosync_compiler PRIVATE fmt::fmt)
