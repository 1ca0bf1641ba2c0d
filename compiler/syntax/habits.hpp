// Mistakes that people bring along: from other languages, and from one construct of RSL to the next. Each is known by the
// words around the place where the grammar stopped, and has a sentence of its own that shows the line as it should be. What
// none of them knows is left to the search for the cheapest change (edit.hpp).
#pragma once

#include <optional>

#include "compiler/diagnostics/diagnostic.hpp"
#include "compiler/source/source_file.hpp"
#include "compiler/syntax/edit.hpp"
#include "compiler/syntax/reader.hpp"

namespace robosync::compiler {

// From one construct of RSL to the next (habits.cpp), from other languages (foreign_habits.cpp), and words that stand
// where they mean something else (misplaced_words.cpp).
// Each reports the habit, and gives the change with which the grammar can go on. Nothing when there is none.
[[nodiscard]] std::optional<Edit> explain_habit(const Tokens& tokens, const SourceFile& source,
                                                const Attempt& failure, Diagnostics& diagnostics);

[[nodiscard]] std::optional<Edit> explain_foreign_habit(const Tokens& tokens,
                                                        const SourceFile& source,
                                                        const Attempt& failure,
                                                        Diagnostics& diagnostics);

[[nodiscard]] std::optional<Edit> explain_misplaced_word(const Tokens& tokens,
                                                         const SourceFile& source,
                                                         const Attempt& failure,
                                                         Diagnostics& diagnostics);

}  // namespace robosync::compiler
