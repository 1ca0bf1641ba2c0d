// Which rules cannot fire in the same step, because their conditions require different values of
// one input: the bands of a CHECK, the states of a STATE, ranges of a channel.
//
// Assumes a verified image. Claims no more than it can prove: `false` says nothing.
#pragma once

#include <map>
#include <vector>

#include "vm/image.hpp"

namespace robosync::analysis {

// The values of an input for which a condition can be true, both ends included.
struct Range {
  vm::Value least = vm::kValueMin, most = vm::kValueMax;
};
using Needs = std::map<std::uint8_t, Range>;  // by input: all of them must hold

// What must hold in every step in which the rule's condition is true. Empty for a rule that may
// fire otherwise: on its ELSE side, or by time alone.
[[nodiscard]] Needs needs_of(const vm::Image& image, const vm::Behavior& behavior,
                             const vm::Rule& rule);
[[nodiscard]] bool exclude_each_other(const Needs& a, const Needs& b);

}  // namespace robosync::analysis
