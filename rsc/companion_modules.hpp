// The algorithm modules that run on a companion computer, as companion/modules.def lists them.
#pragma once

#include <span>
#include <string_view>

#include "compiler/config/algorithm_modules.hpp"

namespace robosync::tool {

// `device`: what the module reads there.
[[nodiscard]] std::span<const compiler::AlgorithmModule> companion_modules();

// What the module `name` does; empty if there is no such module.
[[nodiscard]] std::string_view doc_of_companion_module(std::string_view name);

}  // namespace robosync::tool
