// An image as text: header, wiring, rules, instructions with their source lines.
#pragma once

#include <string>

#include "vm/image.hpp"

namespace robosync::tool {

// `image` must be verified.
[[nodiscard]] std::string dump_text(const vm::Image& image);

}  // namespace robosync::tool
