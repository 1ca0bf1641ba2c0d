// `40 cm`, `2 seconds`: a unit that does not touch its number.
#pragma once

#include <cstddef>
#include <optional>

#include "compiler/diagnostics/diagnostic.hpp"
#include "compiler/source/source_file.hpp"
#include "compiler/syntax/edit.hpp"
#include "compiler/syntax/reader.hpp"

namespace robosync::compiler {

// Is the token at `at` a name directly after digits?
[[nodiscard]] bool is_behind_digits(const Tokens& tokens, const SourceFile& source, std::size_t at);

// `3,5`: is the token at `comma` a comma that touches digits on its left and a number on its right?
[[nodiscard]] bool is_decimal_comma(const Tokens& tokens, const SourceFile& source,
                                    std::size_t comma);

// Reports it if that name is a unit, also of other languages.
bool report_unit_apart(const Tokens& tokens, const SourceFile& source, std::size_t at,
                       Diagnostics& diagnostics);

// Where the grammar stopped: reports it, and returns the change that lets the grammar continue.
[[nodiscard]] std::optional<Edit> explain_unit_apart(const Tokens& tokens, const SourceFile& source,
                                                     const Attempt& failure,
                                                     Diagnostics& diagnostics);

}  // namespace robosync::compiler
