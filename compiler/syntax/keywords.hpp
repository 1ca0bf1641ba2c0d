// The keywords of RSL (keywords.def). Case does not matter.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace robosync::compiler {

[[nodiscard]] bool is_keyword(std::string_view word);
// True when a name in robot.json may be this word: it is not a keyword, or it has a meaning only at the start
// of a line outside all blocks. MOTION is such a word: there are motion sensors.
[[nodiscard]] bool may_name_a_part(std::string_view word);

// Every spelling, in capitals.
[[nodiscard]] const std::vector<std::string>& keyword_spellings();

}  // namespace robosync::compiler
