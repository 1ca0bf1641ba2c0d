// See axes.hpp.
#include "runtime-m4/drivers/axes.hpp"

namespace robosync::drivers {
namespace {

// The integer square root, bit by bit. `square` is at most 3 * 2^30, so the root is below 2^16.
std::int32_t root(std::uint32_t square) {
  std::uint32_t found = 0;
  for (std::uint32_t bit = 1U << 15; bit != 0; bit >>= 1)
    if ((found | bit) * (found | bit) <= square) found |= bit;
  return static_cast<std::int32_t>(found);
}

}  // namespace

Axes axes_of(AxisRegisters registers, std::endian order) {
  const std::size_t low = order == std::endian::little ? 0 : 1;
  Axes axes{};
  for (std::size_t axis = 0; axis < kAxes; ++axis) {
    const auto low_byte = std::to_integer<std::uint16_t>(registers[2 * axis + low]);
    const auto high_byte = std::to_integer<std::uint16_t>(registers[2 * axis + 1 - low]);
    axes[axis] = static_cast<std::int16_t>(high_byte << 8 | low_byte);
  }
  return axes;
}

std::int32_t acceleration(const Axes& axes, unsigned input) {
  if (input < kAxes) return axes[input];
  std::uint32_t square = 0;
  for (const std::int32_t count : axes)
    square += static_cast<std::uint32_t>(count * count);
  return root(square);
}

}  // namespace robosync::drivers
