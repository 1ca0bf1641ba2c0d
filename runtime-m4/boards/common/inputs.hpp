// Where a pin stands in a board's table of inputs.
#pragma once

#include <cstddef>
#include <cstdint>

namespace robosync::boards {

// inputs.size(): it is none of them.
template <typename Inputs>
constexpr std::size_t find_input(const Inputs& inputs, std::uint16_t pin) {
  std::size_t i = 0;
  while (i < inputs.size() && inputs[i].pin != pin)
    ++i;
  return i;
}

}  // namespace robosync::boards
