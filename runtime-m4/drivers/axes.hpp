// What sensors of motion share. Their inputs 0 to 2 are the acceleration along X, Y and Z, 3 is how strong it is, whichever way.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>

namespace robosync::drivers {

inline constexpr unsigned kAxes = 3;
using Axes = std::array<std::int32_t, kAxes>;  // counts of 16 bits
inline constexpr std::size_t kAxesBytes = std::size_t{2} * kAxes;
using AxisRegisters = std::span<const std::byte, kAxesBytes>;  // X, Y, Z

// `order` is that of the two bytes of a count.
Axes axes_of(AxisRegisters registers, std::endian order);

// The input 0, 1 or 2; any other one is their strength.
std::int32_t acceleration(const Axes& axes, unsigned input);

}  // namespace robosync::drivers
