// What the tests of rsc fmt's style share: the programs of this repository, and a text formatted.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "compiler/syntax/format.hpp"
#include "compiler/syntax/parser.hpp"
#include "tests/compiler/compiled.hpp"

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

}  // namespace robosync::compiler::testing
