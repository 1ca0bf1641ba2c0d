// Names, as robot.json and RSL share them: case and underscores do not matter (touchLevel =
// touch_level = TOUCH_LEVEL).
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "compiler/diagnostics/diagnostic.hpp"

namespace robosync::compiler {

[[nodiscard]] std::string fold_name(std::string_view name);  // "touchlevel"
[[nodiscard]] bool same_name(std::string_view a, std::string_view b);

// A text and where it stands.
struct Spelled {
  std::string text;
  Span span;
};

// Reports a name that RSL cannot write (E0103) or that is one of its words (E0102).
void check_name(const Spelled& name, Diagnostics& diagnostics);

// "`a`, `b` and `c`", for messages; at most the first twelve.
[[nodiscard]] std::string list_names(const std::vector<std::string>& names,
                                     std::string_view last = "and");

}  // namespace robosync::compiler
