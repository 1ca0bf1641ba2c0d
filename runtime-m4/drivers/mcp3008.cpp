// Microchip MCP3008: eight analog inputs, 10 bits, against its own reference (DS21295D, chapters 5 and 6).
//
// It ignores zeros before the start bit. After it come "single-ended" and three bits for the input; a clock later it sends a 0,
// the ten bits, and then the same bits again in reverse, the lowest, B0, only once. The byte is placed so that this 0 is the
// first bit of the bytes that are read:
//
//   0 0 start single D2 D1 D0 –   0 B9 B8 B7 B6 B5 B4 B3   B2 B1 B0 B1 B2 B3 B4 B5
//
// Nothing drives the line where no part is connected, so it does not show this 0 if it is pulled up, and the repeated bits show
// most disturbances.
#include "runtime-m4/drivers/drivers.hpp"
#include "runtime-m4/drivers/spi_registers.hpp"

namespace robosync::drivers::mcp3008 {
namespace {

constexpr unsigned kReadSingle = 0b0011'0000;
constexpr unsigned kRepeated = 5;  // bits

// Bits B1 to B5 of `counts`, the lowest first.
constexpr std::uint32_t reversed(std::uint32_t counts) {
  std::uint32_t bits = 0;
  for (unsigned i = 1; i <= kRepeated; ++i)
    bits = bits << 1 | (counts >> i & 1);
  return bits;
}

}  // namespace

bool read(boards::Board& board, const vm::Sensor& sensor, const vm::Channel& channel,
          std::int32_t& raw) {
  std::array<std::byte, 2> in{};
  const unsigned input = channel.input % 8U;
  if (!read_spi(board, sensor, static_cast<std::uint8_t>(kReadSingle | input << 1), in))
    return false;
  const auto word =
      std::to_integer<std::uint32_t>(in[0]) << 8 | std::to_integer<std::uint32_t>(in[1]);
  const std::uint32_t counts = word >> kRepeated;
  raw = static_cast<std::int32_t>(counts);
  return counts < 1024 && (word & ((1U << kRepeated) - 1)) == reversed(counts);
}

}  // namespace robosync::drivers::mcp3008
