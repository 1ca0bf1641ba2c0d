// What to write instead of a verb or an option that rsc does not have.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace robosync::tool {

// "; did you mean `check`?", "; write `rsc check q.rsl`"; empty: nothing comes near.
[[nodiscard]] std::string instead_of_verb(std::string_view word);
// `known`: all options of the verb, "--format" and "-o". Lists them if none comes near.
[[nodiscard]] std::string instead_of_option(std::string_view verb, std::string_view word,
                                            const std::vector<std::string>& known);

}  // namespace robosync::tool
