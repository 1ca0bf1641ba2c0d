// The two halves of an ST LSM303AGR (DocID027765), which have an address each, and their registers laid out alike: an
// accelerometer, of which a count is 7.82 mg, and which measures 200 times a second, up to 4 g along each axis; and a
// magnetometer, of which a count is 0.15 uT, and which measures 100 times a second.
//
// After a loss of power they are asleep, and then report 0 for ever. So each sample also reads the settings: if they are not as
// they should be they are told again, and the next sample is the first good one.
#include <array>
#include <cstdint>
#include <cstring>
#include <span>
#include <tuple>
#include <type_traits>

#include "runtime-m4/drivers/axes.hpp"
#include "runtime-m4/drivers/drivers.hpp"
#include "runtime-m4/drivers/i2c_registers.hpp"

namespace robosync::drivers::lsm303agr {
namespace {

constexpr std::byte kGoOn{0x80};  // go on from one register to the next
// OUT_X_L, counted from the first setting; low byte first for each axis.
constexpr std::size_t kOutput = 8;
using Registers = std::array<std::byte, kOutput + kAxesBytes>;

struct Half {
  std::array<std::byte, 5> order;  // the first setting, and what it and the next ones must be
  unsigned unused;                 // bits below a count
};
// CTRL_REG1_A to CTRL_REG4_A: 200 Hz, all axes, 10 bits, good 1 ms after waking up; no filter; no interrupts; up to 4 g, and the
// two bytes of a count do not change between their reads.
constexpr Half kAccelerometer{
    {std::byte{0x20} | kGoOn, std::byte{0x67}, std::byte{0}, std::byte{0}, std::byte{0x90}}, 6};
// CFG_REG_A_M to CFG_REG_C_M, and INT_CTRL_REG_M as after a reset: 100 Hz, compensated for temperature, good 10 ms after waking
// up; no filter; the two bytes of a count as above.
constexpr Half kMagnetometer{
    {std::byte{0x60} | kGoOn, std::byte{0x8C}, std::byte{0}, std::byte{0x10}, std::byte{0xE0}}, 0};
constexpr std::uint16_t kAddressOfMagnetometer = 0x1E;

const Half& half_of(const vm::Sensor& sensor) {
  return sensor.address == kAddressOfMagnetometer ? kMagnetometer : kAccelerometer;
}

// Not inlined: none of their frames is there during the transfer of another one. A sensor's thread has few bytes left
// (tests/e2e/test_stack_depth.py).
[[gnu::noinline]] bool fetch(boards::Board& board, const vm::Sensor& sensor, Registers& registers) {
  return read_registers(board, sensor, half_of(sensor).order[0], registers);
}

[[gnu::noinline]] void tell(boards::Board& board, const vm::Sensor& sensor) {
  write_registers(board, sensor, half_of(sensor).order);
}

bool is_set_up(const vm::Sensor& sensor, const Registers& registers) {
  const auto& order = half_of(sensor).order;
  static_assert(std::tuple_size_v<std::remove_cvref_t<decltype(order)>> ==
                1 + sizeof(std::uint32_t));
  std::uint32_t wanted = 0;
  std::uint32_t is = 0;
  std::memcpy(&wanted, order.data() + 1, sizeof wanted);
  std::memcpy(&is, registers.data(), sizeof is);
  return is == wanted;
}

std::int32_t count_of(const vm::Sensor& sensor, const Registers& registers, unsigned input) {
  return acceleration(std::span(registers).subspan<kOutput>(), std::endian::little,
                      half_of(sensor).unused, input);
}

}  // namespace

bool read(boards::Board& board, const vm::Sensor& sensor, const vm::Channel& channel,
          std::int32_t& raw) {
  Registers registers;  // not initialized, which would cost as much as reading them
  if (!fetch(board, sensor, registers)) return false;
  if (!is_set_up(sensor, registers)) {
    tell(board, sensor);
    return false;
  }
  raw = count_of(sensor, registers, channel.input);
  return true;
}

}  // namespace robosync::drivers::lsm303agr
