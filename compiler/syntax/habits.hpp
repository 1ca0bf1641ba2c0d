// Mistakes of habit: from other languages, and from one construct of RSL to another. Each is recognised by the words
// around the place where the grammar stopped, and has its own message that shows the correct line. All other mistakes go
// to the search for the cheapest change (edit.hpp).
#pragma once

#include <array>
#include <optional>
#include <string_view>

#include "compiler/diagnostics/diagnostic.hpp"
#include "compiler/source/source_file.hpp"
#include "compiler/syntax/edit.hpp"
#include "compiler/syntax/reader.hpp"

namespace robosync::compiler {

class Examples;

// What a WHEN, a WHILE or an EVERY in a response is meant for, and what to write instead.
[[nodiscard]] constexpr std::string_view in_response(TokenKind rule) {
  if (rule == Kinds::WHILE)
    return "to repeat something here, write `REPEAT WHILE` and the condition, with a `WAIT` in it";
  if (rule == Kinds::EVERY)
    return "to repeat something here, write `REPEAT FOREVER`, with a `WAIT` in it";
  return "to check once while the response runs, write `IF`";
}

// What other languages write in place of DEFINE.
inline constexpr std::array<std::string_view, 9> kForeignDefines = {
    "FUNCTION", "FUNC", "FUN", "FN", "DEF", "PROCEDURE", "PROC", "SUB", "VOID"};

// What to do with two commands in one line.
inline constexpr const char* kOwnLine = "write each command on its own line: they start together";

// Habits from other constructs of RSL (habits.cpp) and from other languages (foreign_habits.cpp), and words that mean
// something else where they are (misplaced_words.cpp), or that people say (spoken_forms.cpp).
// Each reports the habit and returns the change that lets the grammar continue; nothing when it finds none.
[[nodiscard]] std::optional<Edit> explain_habit(const Tokens& tokens, const SourceFile& source,
                                                const Attempt& failure, Diagnostics& diagnostics);

[[nodiscard]] std::optional<Edit> explain_foreign_habit(const Tokens& tokens,
                                                        const SourceFile& source,
                                                        const Attempt& failure,
                                                        Diagnostics& diagnostics);

[[nodiscard]] std::optional<Edit> explain_spoken_form(const Tokens& tokens,
                                                      const SourceFile& source,
                                                      const Attempt& failure,
                                                      Diagnostics& diagnostics);

[[nodiscard]] std::optional<Edit> explain_misplaced_word(const Tokens& tokens,
                                                         const SourceFile& source,
                                                         const Attempt& failure,
                                                         Diagnostics& diagnostics);

// Lines in a form that RSL lacks, as beginners write them (wrong_forms.cpp).
[[nodiscard]] std::optional<Edit> explain_wrong_form(const Tokens& tokens, const SourceFile& source,
                                                     const Attempt& failure,
                                                     Diagnostics& diagnostics);

// Lines that only the robot's names tell from other mistakes (robot_lines.cpp). `SAY "a", SHOW eyes happy`: looks like a wrong
// text, so it comes before the others.
[[nodiscard]] std::optional<Edit> explain_joined_command(const Tokens& tokens,
                                                         const SourceFile& source,
                                                         const Attempt& failure,
                                                         const Examples& examples,
                                                         Diagnostics& diagnostics);
// `RAISE left_arm`
[[nodiscard]] std::optional<Edit> explain_raised(const Tokens& tokens, const SourceFile& source,
                                                 const Attempt& failure, const Examples& examples,
                                                 Diagnostics& diagnostics);
// `WHEN I see a person`
[[nodiscard]] std::optional<Edit> explain_sentence(const Tokens& tokens, const SourceFile& source,
                                                   const Attempt& failure, const Examples& examples,
                                                   Diagnostics& diagnostics);

}  // namespace robosync::compiler
