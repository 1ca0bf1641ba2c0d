// The index of a pin in a board's table of inputs.
#pragma once

#include <cstddef>
#include <cstdint>

namespace robosync::boards {

// inputs.size() if the pin is not in the table.
template <typename Inputs>
constexpr std::size_t find_input(const Inputs& inputs, std::uint16_t pin) {
  std::size_t i = 0;
  while (i < inputs.size() && inputs[i].pin != pin)
    ++i;
  return i;
}

}  // namespace robosync::boards
