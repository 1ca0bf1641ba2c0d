// An image as text: header, wiring, rules, instructions with their source lines.
#pragma once

#include <string>
#include <vector>

#include "vm/image.hpp"

namespace robosync::tool {

using SourceLines = std::vector<std::string>;

// `image` must be verified. `source`: the lines of its program, or empty.
[[nodiscard]] std::string dump_text(const vm::Image& image, const SourceLines& source = {});

}  // namespace robosync::tool
