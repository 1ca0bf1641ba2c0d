# The front end: text to tree, and the diagnostics of the whole compiler.
find_package(nlohmann_json 3.11 REQUIRED)
find_package(ZLIB REQUIRED)
find_package(BISON 3.8 REQUIRED)
find_program(RE2C re2c REQUIRED)

# A conflict in the grammar, or a lexer pattern that can never match, stops the build. Bison's code zeroes the storage for
# the largest value type whenever it constructs an empty value, several times per token. That took a quarter of the time
# of rsc check, so sed removes it. The storage is never read before a value is constructed in it.
set(generated ${CMAKE_CURRENT_BINARY_DIR}/generated)
file(MAKE_DIRECTORY ${generated}/grammar)
add_custom_command(
  OUTPUT ${generated}/grammar/rsl_grammar.cpp ${generated}/grammar/rsl.hpp
  COMMAND ${BISON_EXECUTABLE} -Wall -Wcounterexamples -Werror
          --output=${generated}/grammar/rsl_grammar.cpp --header=${generated}/grammar/rsl.hpp
          ${PROJECT_SOURCE_DIR}/grammar/rsl.yy
  COMMAND sed -i "/^ *: yyraw_ ()$/d" ${generated}/grammar/rsl.hpp
  DEPENDS ${PROJECT_SOURCE_DIR}/grammar/rsl.yy
  COMMENT "Bison: grammar/rsl.yy"
  VERBATIM)
add_custom_command(
  OUTPUT ${generated}/grammar/rsl_lexer.cpp
  COMMAND ${RE2C} -W -Werror --no-debug-info --output ${generated}/grammar/rsl_lexer.cpp
          ${PROJECT_SOURCE_DIR}/grammar/rsl.re
  DEPENDS ${PROJECT_SOURCE_DIR}/grammar/rsl.re
  COMMENT "re2c: grammar/rsl.re"
  VERBATIM)
# Both libraries include the header that Bison writes.
add_custom_target(robosync_grammar DEPENDS ${generated}/grammar/rsl.hpp)
add_dependencies(robosync_compiler robosync_grammar)
add_dependencies(robosync_compiler_small robosync_grammar)
target_include_directories(robosync_compiler_small SYSTEM PRIVATE ${generated})
# Their style is not ours to fix. Under the sanitizers the parser takes four times as long to compile with -O1 as with -O0.
# Otherwise it is built for size: with -O3 it is 46 KB larger, and `rsc check` a quarter faster.
foreach(part_and_level "grammar;-Os" "lexer;-O3")
  list(GET part_and_level 0 part)
  list(GET part_and_level 1 level)
  set_source_files_properties(${generated}/grammar/rsl_${part}.cpp PROPERTIES
    COMPILE_OPTIONS "$<IF:$<BOOL:${ROBOSYNC_SANITIZE}>,-O0,${level}>;-Wno-conversion;-Wno-sign-conversion;-Wno-shadow")
endforeach()

target_sources(robosync_compiler PRIVATE
  ${generated}/grammar/rsl_grammar.cpp
  ${generated}/grammar/rsl_lexer.cpp
  source/source_file.cpp
  source/utf8.cpp
  diagnostics/plain_text.cpp
  syntax/blocks.cpp
  syntax/builder.cpp
  syntax/keywords.cpp
  syntax/layout.cpp
  syntax/lexer_state.cpp
  syntax/reader.cpp)
# Public for the tests, which look at tokens. SYSTEM silences warnings inside the generated header.
target_include_directories(robosync_compiler SYSTEM PUBLIC $<BUILD_INTERFACE:${generated}>)
target_link_libraries(robosync_compiler PRIVATE nlohmann_json::nlohmann_json ZLIB::ZLIB)
# The code that words a mistake is long, runs seldom, and prints at most 20 messages.
target_sources(robosync_compiler_small PRIVATE
  source/character_names.cpp
  source/embedded.cpp
  source/json.cpp
  diagnostics/diagnostic.cpp
  diagnostics/nearest.cpp
  diagnostics/render_human.cpp
  diagnostics/render_json.cpp
  diagnostics/sarif.cpp
  diagnostics/snippet.cpp
  syntax/articles.cpp
  syntax/breaks.cpp
  syntax/condition_behind.cpp
  syntax/edit.cpp
  syntax/examples.cpp
  syntax/expect_within.cpp
  syntax/foreign_habits.cpp
  syntax/foreign_ranges.cpp
  syntax/foreign_text.cpp
  syntax/foreign_words.cpp
  syntax/format.cpp
  syntax/habits.cpp
  syntax/heads.cpp
  syntax/indented_blocks.cpp
  syntax/lexer_habits.cpp
  syntax/lexer_mistakes.cpp
  syntax/line_starts.cpp
  syntax/lost_heads.cpp
  syntax/misplaced_words.cpp
  syntax/missing.cpp
  syntax/number_words.cpp
  syntax/one_line_blocks.cpp
  syntax/parser.cpp
  syntax/pasted.cpp
  syntax/repair.cpp
  syntax/robot_lines.cpp
  syntax/spoken_forms.cpp
  syntax/spoken_words.cpp
  syntax/torn_names.cpp
  syntax/unit_apart.cpp
  syntax/wording.cpp
  syntax/wrong_forms.cpp
  units/foreign_units.cpp)
