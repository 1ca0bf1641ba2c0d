// The keywords of RSL (keywords.def) and what each may do in a line. Case does not matter.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace robosync::compiler {

[[nodiscard]] bool is_keyword(std::string_view word);

// Every spelling, in capitals.
[[nodiscard]] const std::vector<std::string>& keyword_spellings();

}  // namespace robosync::compiler
