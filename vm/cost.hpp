// What the code of an image costs, rule by rule: for people, who want to know which rule is dear.
// For the host; the firmware does not link it.
//
// The figures are what the verifier's own pass finds for each code object, and their sum is what it
// finds for a step (step_cost()), so there is no second model of the costs.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>

#include "vm/image.hpp"
#include "vm/interpreter.hpp"

namespace robosync::vm {

// In worst-case M4 instructions; of a response the costliest part between two waits.
struct RuleCost {
  std::uint32_t condition = 0;  // 0 of a rule without one
  std::uint32_t then_response = 0;
  std::uint32_t else_response = 0;

  // In one step a rule runs one of them.
  [[nodiscard]] constexpr std::uint32_t worst_response() const {
    return std::max(then_response, else_response);
  }
  [[nodiscard]] constexpr std::uint32_t step() const { return condition + worst_response(); }
};

// One for each of the image's rules; `costs` has as many places. False for an image whose code
// would be refused for anything but what a step costs. `image` must be a view that view_image()
// accepted.
[[nodiscard]] bool rule_costs(const Image& image, std::span<RuleCost> costs);

// Of a Machine on the board, where a pointer has 4 bytes.
inline constexpr std::size_t kMachineBytes = 48;
static_assert(sizeof(void*) != 4 || sizeof(Machine) == kMachineBytes);

}  // namespace robosync::vm
