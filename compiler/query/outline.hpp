// The items of a program or of a robot.json, as a list for navigation.
#pragma once

#include <string>
#include <vector>

#include "compiler/query/project.hpp"

namespace robosync::compiler::query {

enum class OutlineKind : std::uint8_t {
  constant,
  variable,
  block,
  define,
  behavior,
  rule,
  test,
  part,     // of a robot.json: a sensor or an actuator
  channel,  // … of a sensor
  list      // … a group, a picture
};

struct OutlineItem {
  std::string name;
  OutlineKind kind{};
  Span span;  // the whole item
  Span name_span;
  std::vector<OutlineItem> inside;
};

// From a tree of the parser.
[[nodiscard]] std::vector<OutlineItem> outline(const ast::Tree& tree, const SourceMap& sources);

}  // namespace robosync::compiler::query
