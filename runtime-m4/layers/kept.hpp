// KEPT numbers, in the form in which they outlive their program. They are found by name, also from another program.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "vm/image.hpp"

namespace robosync::layers {

struct KeptNumber {
  std::uint32_t key;  // kept_key()
  vm::Value value;
  bool operator==(const KeptNumber&) const = default;
};

// From a variable's name, ignoring case, and what it measures: a distance is not a time.
[[nodiscard]] std::uint32_t kept_key(const vm::Image& image, const vm::Variable& variable);

// The initial value of `variable`: the number in `kept`, clamped to its range, or else the written one.
[[nodiscard]] vm::Value initial_of(const vm::Image& image, const vm::Variable& variable,
                                   std::span<const KeptNumber> kept);

}  // namespace robosync::layers
