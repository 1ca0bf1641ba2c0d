// The numeric functions (functions.def) by name.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <string_view>

#include "compiler/source/ascii.hpp"

namespace robosync::compiler {

struct FunctionName {
  std::string_view name;
  std::size_t arguments;
};

inline constexpr std::array kFunctions = {
#define FUNCTION(name, operation, arguments) FunctionName{#name, arguments},
#include "compiler/syntax/functions.def"
#undef FUNCTION
};

// Ignores case; null for any other word.
[[nodiscard]] inline const FunctionName* find_function(std::string_view word) {
  const auto* const found = std::ranges::find_if(
      kFunctions, [word](const FunctionName& known) { return ascii::same(known.name, word); });
  return found == kFunctions.end() ? nullptr : found;
}

}  // namespace robosync::compiler
