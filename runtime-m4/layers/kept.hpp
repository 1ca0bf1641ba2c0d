// KEPT numbers, as they outlast their program: found again by their names, in another program too.
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

// Of a variable's name, whichever way it is written, and what it measures: a distance is not a time.
[[nodiscard]] std::uint32_t kept_key(const vm::Image& image, const vm::Variable& variable);

// What `variable` begins with: the number in `kept`, inside of its range, or what is written.
[[nodiscard]] vm::Value initial_of(const vm::Image& image, const vm::Variable& variable,
                                   std::span<const KeptNumber> kept);

}  // namespace robosync::layers
