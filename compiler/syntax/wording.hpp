// Explains in the user's words what was wrong where the grammar stopped.
#pragma once

#include <string>
#include <vector>

#include "compiler/diagnostics/diagnostic.hpp"
#include "compiler/source/source_file.hpp"
#include "compiler/syntax/edit.hpp"
#include "compiler/syntax/examples.hpp"
#include "compiler/syntax/reader.hpp"

namespace robosync::compiler {

struct Mistake {
  const Tokens& tokens;
  const SourceFile& source;
  const Attempt& failure;
  const Edit& edit;  // what repairs it
  const Examples& examples;
};

// Reports the mistake with its fix.
void explain(const Mistake& mistake, Diagnostics& diagnostics);

// "a value", "a comparison such as `<`", "`DO`": the user's term for a missing token, where `expected` was accepted.
[[nodiscard]] std::string what_is_missing(TokenKind kind, const std::vector<TokenKind>& expected);

}  // namespace robosync::compiler
