// The keywords of RSL (keywords.def) and what each may do in a line. Case does not matter.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace robosync::compiler {

[[nodiscard]] bool is_keyword(std::string_view word);
// May something of robot.json have this name? Any word that is no keyword, and one that means something
// only where it begins a line outside all blocks, as MOTION does: there are sensors of motion.
[[nodiscard]] bool may_name_a_part(std::string_view word);

// Every spelling, in capitals.
[[nodiscard]] const std::vector<std::string>& keyword_spellings();

}  // namespace robosync::compiler
