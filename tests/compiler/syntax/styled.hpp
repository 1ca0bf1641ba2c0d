// What the tests of rsc fmt's style share: the programs of this repository, and a text formatted.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "compiler/syntax/format.hpp"
#include "compiler/syntax/lexer.hpp"
#include "compiler/syntax/parser.hpp"
#include "tests/compiler/compiled.hpp"
#include "tests/support/share.hpp"

namespace robosync::compiler::testing {

// The text formatted; that of a program with a mistake is empty.
inline std::string styled(const std::string& text) {
  SourceMap sources;
  Diagnostics diagnostics;
  const FileId file = sources.add("robot.rsl", text);
  const ast::Tree tree = parse(sources, file, diagnostics);
  return diagnostics.errors() > 0 ? "" : formatted(sources, file, tree).value_or("changed");
}

inline std::vector<std::filesystem::path> programs() {
  return files_in({"examples", "stdlib"}, ".rsl");
}

// Calls take(text) for each of these without one of its words: not all of them are programs. A share of them.
template <class Take>
void each_without_a_word(Take take) {
  std::size_t number = 0;
  for (const std::filesystem::path& path : programs()) {
    SourceMap sources;
    Diagnostics ignored;
    const std::string text = read_file(path);
    const FileId file = sources.add("robot.rsl", text);
    for (const Token& token : lex(sources.file(file), file, ignored)) {
      if (token.span.begin == token.span.end || !robosync::test::in_share(number++)) continue;
      std::string other = text;
      other.erase(token.span.begin, token.span.end - token.span.begin);
      take(other);
    }
  }
}

}  // namespace robosync::compiler::testing
