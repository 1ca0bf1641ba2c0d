// The values that a program's rules compare its inputs with, drawn as lines in a sensor's curve.
#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

#include "vm/image.hpp"

namespace robosync::tool {

struct Threshold {
  std::size_t input;      // channels, then variables, as the image numbers inputs
  std::string_view text;  // "<", ">=" …; for a band, its name; the band begins there
  vm::Value value;
  std::size_t rule;  // kNoRule: a band of a CHECK
  static constexpr std::size_t kNoRule = SIZE_MAX;
};

// Comparisons of an input with a constant, in conditions and responses, each once per rule, and the starts of
// bands. `image` is verified.
[[nodiscard]] std::vector<Threshold> thresholds_of(const vm::Image& image);

}  // namespace robosync::tool
