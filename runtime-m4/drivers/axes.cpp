// See axes.hpp.
#include "runtime-m4/drivers/axes.hpp"

namespace robosync::drivers {
namespace {

// The integer square root, bit by bit from the highest one it can have. `square` is at most 3 * 2^30, so the root is below 2^16.
std::int32_t root(std::uint32_t square) {
  std::uint32_t found = 0;
  for (std::uint32_t bit = 1U << (std::bit_width(square | 1) - 1) / 2; bit != 0; bit >>= 1)
    if ((found | bit) * (found | bit) <= square) found |= bit;
  return static_cast<std::int32_t>(found);
}

}  // namespace

std::int32_t acceleration(AxisRegisters registers, std::endian order, unsigned unused,
                          unsigned input) {
  if (input < kAxes) return axis_of(registers, input, order) >> unused;
  std::uint32_t square = 0;
  for (unsigned axis = 0; axis < kAxes; ++axis) {
    const std::int32_t count = axis_of(registers, axis, order) >> unused;
    square += static_cast<std::uint32_t>(count * count);
  }
  return root(square);
}

}  // namespace robosync::drivers
