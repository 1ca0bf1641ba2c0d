// What motion sensors share. Inputs 0 to 2 are the acceleration along X, Y and Z; input 3 is its magnitude.
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

// `order` is the byte order of a count.
Axes axes_of(AxisRegisters registers, std::endian order);

// Input 0, 1 or 2; any other is the magnitude.
std::int32_t acceleration(const Axes& axes, unsigned input);

}  // namespace robosync::drivers
