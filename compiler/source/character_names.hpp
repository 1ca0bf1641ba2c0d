// The name of a character, for messages about one that does not belong where it is.
#pragma once

#include <string>

namespace robosync::compiler::utf8 {

// "`@` (U+0040, at sign)"; for a character that cannot be shown, "U+200B (zero width space)".
[[nodiscard]] std::string describe(char32_t code_point);

}  // namespace robosync::compiler::utf8
