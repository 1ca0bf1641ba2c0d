// What can be asked about: trees, as the parser made them, and a robot. Neither need be free of mistakes.
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
  const Robot& robot;                    // an empty one when robot.json cannot be read
  std::vector<LibraryModule> library{};  // what USE could name
};

}  // namespace robosync::compiler::query
