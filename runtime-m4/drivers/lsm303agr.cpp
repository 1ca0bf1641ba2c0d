// The accelerometer of an ST LSM303AGR (DocID027765). A count is 7.82 mg; it measures 200 times a second, up to 4 g along each axis.
//
// Out of a loss of power it comes asleep, and then says 0 for ever. So what it is told to do is read with each sample: when it
// is asleep it is told again, and the next sample is the first good one.
#include <array>
#include <cstdint>
#include <span>

#include "runtime-m4/drivers/axes.hpp"
#include "runtime-m4/drivers/drivers.hpp"
#include "runtime-m4/drivers/i2c_registers.hpp"

namespace robosync::drivers::lsm303agr {
namespace {

constexpr std::byte kGoOn{0x80};    // from a register to the next
constexpr std::byte kFirst{0x20};   // CTRL_REG1_A
constexpr std::size_t kRange = 3;   // CTRL_REG4_A, from there
constexpr std::size_t kOutput = 8;  // OUT_X_L_A; of each axis the low byte first
constexpr std::byte k200Hz{0x67};   // all axes, 10 bits: good 1 ms after it has woken up
constexpr std::byte kUpTo4g{0x90};  // no byte of a count changes between the reading of both
constexpr unsigned kUnused = 6;     // bits below those of a count
using Registers = std::array<std::byte, kOutput + kAxesBytes>;

Axes counts_of(const Registers& registers) {
  Axes axes = axes_of(std::span(registers).subspan<kOutput>(), std::endian::little);
  for (std::int32_t& count : axes)
    count >>= kUnused;
  return axes;
}

}  // namespace

bool read(boards::Board& board, const vm::Sensor& sensor, const vm::Channel& channel,
          std::int32_t& raw) {
  Registers registers{};
  if (!read_registers(board, sensor, kFirst | kGoOn, registers)) return false;
  if (registers[0] != k200Hz || registers[kRange] != kUpTo4g) {
    constexpr std::byte kOff{0};  // its filter, its interrupts
    write_registers(board, sensor, std::array{kFirst | kGoOn, k200Hz, kOff, kOff, kUpTo4g});
    return false;
  }
  raw = acceleration(counts_of(registers), channel.input);
  return true;
}

}  // namespace robosync::drivers::lsm303agr
