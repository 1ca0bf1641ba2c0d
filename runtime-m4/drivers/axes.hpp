// What sensors with three axes share. Inputs 0 to 2 are the acceleration along X, Y and Z, or the magnetic field; input 3 is its
// magnitude.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>

namespace robosync::drivers {

inline constexpr unsigned kAxes = 3;
inline constexpr std::size_t kAxesBytes = std::size_t{2} * kAxes;
using AxisRegisters = std::span<const std::byte, kAxesBytes>;  // X, Y, Z

// A count. `order` is its byte order.
inline std::int32_t axis_of(AxisRegisters registers, std::size_t axis, std::endian order) {
  const std::size_t low = order == std::endian::little ? 0 : 1;
  const auto low_byte = std::to_integer<std::uint16_t>(registers[2 * axis + low]);
  const auto high_byte = std::to_integer<std::uint16_t>(registers[2 * axis + 1 - low]);
  return static_cast<std::int16_t>(high_byte << 8 | low_byte);
}

// Of these counts, without their lowest bits that are `unused`: input 0, 1 or 2; any other is the magnitude.
std::int32_t acceleration(AxisRegisters registers, std::endian order, unsigned unused,
                          unsigned input);

}  // namespace robosync::drivers
