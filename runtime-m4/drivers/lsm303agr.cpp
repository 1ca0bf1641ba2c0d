// The accelerometer of an ST LSM303AGR (DocID027765). A count is 7.82 mg; it measures 200 times a second, up to 4 g along each axis.
//
// After a loss of power it is asleep, and then reports 0 for ever. So each sample also reads its setting: if it
// is asleep it is told again, and the next sample is the first good one.
#include <array>
#include <cstdint>
#include <span>

#include "runtime-m4/drivers/axes.hpp"
#include "runtime-m4/drivers/drivers.hpp"
#include "runtime-m4/drivers/i2c_registers.hpp"

namespace robosync::drivers::lsm303agr {
namespace {

constexpr std::byte kGoOn{0x80};    // go on from one register to the next
constexpr std::byte kFirst{0x20};   // CTRL_REG1_A
constexpr std::size_t kRange = 3;   // CTRL_REG4_A, counted from there
constexpr std::size_t kOutput = 8;  // OUT_X_L_A; low byte first for each axis
constexpr std::byte k200Hz{0x67};   // all axes, 10 bits: good 1 ms after waking up
constexpr std::byte kUpTo4g{0x90};  // the two bytes of a count do not change between their reads
constexpr unsigned kUnused = 6;     // bits below a count
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
