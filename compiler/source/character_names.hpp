// What a character is called, for messages about one that is not meant to be where it is.
#pragma once

#include <string>

namespace robosync::compiler::utf8 {

// "`@` (U+0040, at sign)"; of one that cannot be shown "U+200B (zero width space)".
[[nodiscard]] std::string describe(char32_t code_point);

}  // namespace robosync::compiler::utf8
