// The items of a program, as a list for navigation.
#pragma once

#include <string>
#include <vector>

#include "compiler/query/project.hpp"

namespace robosync::compiler::query {

enum class OutlineKind : std::uint8_t { constant, variable, block, define, behavior, rule, test };

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
