// An MCP3008, bit by bit, from its data sheet (DS21295D, chapter 5): it reads DIN at each rising edge of the clock, and sets DOUT
// at the falling one after it. Where it does not drive DOUT, the pull-up of the board does.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace robosync::test {

class Mcp3008 {
public:
  static constexpr unsigned kInputs = 8;
  std::array<std::uint16_t, kInputs> counts{};
  bool connected = true;
  bool pulled_up = true;
  std::uint32_t disturbed = 0;  // bit i: bit i of a transfer arrives inverted

  // One transfer, while its select input is low.
  void transfer(std::span<const std::byte> out, std::span<std::byte> in) {
    clocks_ = 0;
    for (std::size_t i = 0; i < out.size() + in.size(); ++i) {
      const auto byte = i < out.size() ? std::to_integer<unsigned>(out[i]) : 0U;
      unsigned received = 0;
      for (unsigned bit = 0; bit < 8; ++bit) {
        const bool level = dout() != ((disturbed >> (8 * i + bit) & 1) != 0);
        received = received << 1 | (level ? 1U : 0U);
        clock((byte >> (7 - bit) & 1) != 0);
      }
      if (i >= out.size()) in[i - out.size()] = static_cast<std::byte>(received);
    }
  }

private:
  // A rising edge and the falling one after it; `clocks_` counts from the start bit on.
  void clock(bool din) {
    if (clocks_ == 0 && !din) return;
    ++clocks_;
    if (clocks_ == 2) single_ = din;
    if (clocks_ >= 3 && clocks_ <= 5) input_ = input_ << 1 | (din ? 1U : 0U);
    if (clocks_ == 2) input_ = 0;
  }

  // The null bit follows the clock that ends the sampling, the sixth; then B9 to B0, then B1 to B9, then zeros.
  bool dout() const {
    if (!connected || clocks_ < 6) return pulled_up;
    const std::uint16_t value = single_ ? counts[input_] : std::uint16_t{0x155};
    const unsigned place = clocks_ - 6;
    if (place == 0 || place > 19) return false;
    const unsigned bit = place <= 10 ? 10 - place : place - 10;
    return (value >> bit & 1) != 0;
  }

  unsigned clocks_ = 0, input_ = 0;
  bool single_ = false;
};

}  // namespace robosync::test
