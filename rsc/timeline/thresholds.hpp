// What the rules of a program compare its inputs with: the lines that a picture of a sensor needs.
#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

#include "vm/image.hpp"

namespace robosync::tool {

struct Threshold {
  std::size_t input;      // channel, or behind them variable, as the image numbers inputs
  std::string_view text;  // "<", ">=" …; of a band: its name, which begins there
  vm::Value value;
  std::size_t rule;  // kNoRule: a band of a CHECK
  static constexpr std::size_t kNoRule = SIZE_MAX;
};

// Comparisons of an input with a constant, in conditions and responses, each once a rule, and where bands begin.
// `image` is verified.
[[nodiscard]] std::vector<Threshold> thresholds_of(const vm::Image& image);

}  // namespace robosync::tool
