// The input for queries: trees from the parser, and a robot. Either may have mistakes.
#pragma once

#include <string_view>
#include <vector>

#include "compiler/config/robot.hpp"
#include "compiler/sema/names.hpp"
#include "compiler/source/source_file.hpp"

namespace robosync::compiler::query {

struct LibraryModule {
  std::string_view name, text;
};

struct Project {
  const SourceMap& sources;
  Trees trees;                           // the program first, then its modules
  const Robot& robot;                    // empty if robot.json cannot be read
  std::vector<LibraryModule> library{};  // the modules that USE can name
};

}  // namespace robosync::compiler::query
