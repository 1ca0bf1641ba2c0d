// The algorithm modules that run on a companion computer, as companion/modules.def lists them.
#pragma once

#include <span>
#include <string_view>

#include "compiler/config/algorithm_modules.hpp"

namespace robosync::tool {

// Their `device` says what they read there.
[[nodiscard]] std::span<const compiler::AlgorithmModule> companion_modules();

// What the module called `name` does; empty when there is none.
[[nodiscard]] std::string_view doc_of_companion_module(std::string_view name);

}  // namespace robosync::tool
