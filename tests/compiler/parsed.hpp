// Programs through the parser, for the tests.
#pragma once

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "compiler/diagnostics/diagnostic.hpp"
#include "compiler/diagnostics/render.hpp"
#include "compiler/source/source_file.hpp"
#include "compiler/syntax/parser.hpp"
#include "tests/support/golden.hpp"

namespace robosync::compiler::testing {

inline std::filesystem::path syntax_folder() {
  return std::filesystem::path(ROBOSYNC_SOURCE_DIR) / "tests/compiler/syntax";
}

// The files of a folder of the parser's tests that end with `extension`, by name.
inline std::vector<std::filesystem::path> files_in(const std::string& folder,
                                                   const std::string& extension) {
  std::vector<std::filesystem::path> paths;
  for (const auto& entry : std::filesystem::directory_iterator(syntax_folder() / folder)) {
    if (entry.path().extension() == extension) paths.push_back(entry.path());
  }
  std::sort(paths.begin(), paths.end());
  return paths;
}

// A program after the parser, with all that was said.
struct Parsed {
  SourceMap sources;
  Diagnostics diagnostics;
  ast::Tree program;
};

inline Parsed parse_text(std::string text, const std::string& name = "robot.rsl") {
  Parsed parsed;
  const FileId file = parsed.sources.add(name, std::move(text));
  parsed.program = parse(parsed.sources, file, parsed.diagnostics);
  parsed.diagnostics.finish();
  return parsed;
}

inline std::string messages(const Parsed& parsed) {
  return render_human(parsed.diagnostics, parsed.sources, false, SIZE_MAX);
}

}  // namespace robosync::compiler::testing
