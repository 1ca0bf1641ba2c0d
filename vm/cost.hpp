// The cost of an image's code, rule by rule, to show which rules are expensive. For the host; the
// firmware does not link it.
//
// The verifier's own pass computes the cost of each code object, and their sum is its cost of a step
// (step_cost()), so there is no second cost model.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>

#include "vm/image.hpp"
#include "vm/interpreter.hpp"

namespace robosync::vm {

// In worst-case M4 instructions; for a response, the costliest part between two waits.
struct RuleCost {
  std::uint32_t condition = 0;  // 0 for a rule without one
  std::uint32_t then_response = 0;
  std::uint32_t else_response = 0;

  // A rule runs only one of its responses in a step.
  [[nodiscard]] constexpr std::uint32_t worst_response() const {
    return std::max(then_response, else_response);
  }
  [[nodiscard]] constexpr std::uint32_t step() const { return condition + worst_response(); }
};

// Computes the cost of each rule; `costs` has one element per rule. False if the code would be refused
// for any reason but the cost of a step. `image` must be a view that view_image() accepted.
[[nodiscard]] bool rule_costs(const Image& image, std::span<RuleCost> costs);

// The size of a Machine on the board, where a pointer has 4 bytes.
inline constexpr std::size_t kMachineBytes = 48;
static_assert(sizeof(void*) != 4 || sizeof(Machine) == kMachineBytes);

}  // namespace robosync::vm
