// The one style of robot.json: a line for each part of the robot, in the text's order; parts with the same keys form a table.
// A value that is too long for its line continues on the next one, aligned behind its bracket.
//
// Only white space changes. Blank lines between the parts stay, repeated ones become one.
#pragma once

#include <string>

#include "compiler/config/json_reader.hpp"
#include "compiler/source/source_file.hpp"

namespace robosync::compiler::json {

// `root` is what read() returned for the file.
[[nodiscard]] std::string formatted(const SourceMap& sources, FileId file, const Value& root);

}  // namespace robosync::compiler::json
