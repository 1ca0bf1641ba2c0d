// The accelerometer of an ST LSM303AGR (DocID027765): inputs 0 to 2 are the acceleration along X, Y and Z, 3 is how strong it
// is, whichever way. A count is 7.82 mg; it measures 200 times a second, up to 4 g along each axis.
//
// Out of a loss of power it comes asleep, and then says 0 for ever. So what it is told to do is read with each sample: when it
// is asleep it is told again, and the next sample is the first good one.
#include <array>
#include <cstdint>
#include <span>

#include "runtime-m4/drivers/drivers.hpp"

namespace robosync::drivers::lsm303agr {
namespace {

constexpr std::byte kGoOn{0x80};    // from a register to the next
constexpr std::byte kFirst{0x20};   // CTRL_REG1_A
constexpr std::size_t kRange = 3;   // CTRL_REG4_A, from there
constexpr std::size_t kOutput = 8;  // OUT_X_L_A; of each axis the low byte first
constexpr std::byte k200Hz{0x67};   // all axes, 10 bits: good 1 ms after it has woken up
constexpr std::byte kUpTo4g{0x90};  // no byte of a count changes between the reading of both
constexpr unsigned kUnused = 6;     // bits below those of a count
constexpr std::uint8_t kAxes = 3;
using Registers = std::array<std::byte, kOutput + 2 * std::size_t{kAxes}>;

std::int32_t along(const Registers& registers, unsigned axis) {
  const std::size_t at = kOutput + std::size_t{2} * axis;
  const auto low = std::to_integer<std::uint16_t>(registers[at]);
  const auto high = std::to_integer<std::uint16_t>(registers[at + 1]);
  return static_cast<std::int16_t>(high << 8 | low) >> kUnused;
}

// The whole root, bit by bit; of at most 3 * 2^18, so it is below 2^10.
std::int32_t root(std::uint32_t square) {
  std::uint32_t found = 0;
  for (std::uint32_t bit = 1U << 9; bit != 0; bit >>= 1)
    if ((found | bit) * (found | bit) <= square) found |= bit;
  return static_cast<std::int32_t>(found);
}

std::int32_t strength(const Registers& registers) {
  std::uint32_t square = 0;
  for (unsigned axis = 0; axis < kAxes; ++axis) {
    const std::int32_t count = along(registers, axis);
    square += static_cast<std::uint32_t>(count * count);
  }
  return root(square);
}

}  // namespace

bool read(boards::Board& board, const vm::Sensor& sensor, const vm::Channel& channel,
          std::int32_t& raw) {
  const auto address = static_cast<std::uint8_t>(sensor.address);
  const std::array from{kFirst | kGoOn};
  Registers registers{};
  if (!board.i2c_transfer(sensor.bus, address, from, registers)) return false;
  if (registers[0] != k200Hz || registers[kRange] != kUpTo4g) {
    constexpr std::byte kOff{0};  // its filter, its interrupts
    const std::array wake{kFirst | kGoOn, k200Hz, kOff, kOff, kUpTo4g};
    static_cast<void>(board.i2c_transfer(sensor.bus, address, wake, {}));
    return false;
  }
  raw = channel.input < kAxes ? along(registers, channel.input) : strength(registers);
  return true;
}

}  // namespace robosync::drivers::lsm303agr
