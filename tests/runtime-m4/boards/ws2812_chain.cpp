// See ws2812_chain.hpp.
#include "tests/runtime-m4/boards/ws2812_chain.hpp"

#include <optional>

namespace robosync::tests {
namespace {

constexpr unsigned kReset = 280'000;  // of the newer ones; 50'000 of the older ones
constexpr unsigned kBitsOfLight = 24;

// 0.4 us high and 0.85 low, or 0.8 and 0.45, each 0.15 more or less.
constexpr bool is_about(unsigned ns, unsigned wanted) {
  return ns + 150 >= wanted && ns <= wanted + 150;
}

}  // namespace

void Ws2812Chain::hear(bool high, unsigned ns) {
  if (high) {
    if (low_ns_ != 0 && high_ns_ != 0) end_bit(false);
    low_ns_ = 0;
    high_ns_ += ns;
    return;
  }
  const bool was_over = low_ns_ >= kReset;
  low_ns_ += ns;
  if (low_ns_ < kReset || was_over) return;
  if (high_ns_ != 0) end_bit(true);
  end_picture();
}

// The last bit before silence may have any low time.
void Ws2812Chain::end_bit(bool silence) {
  std::optional<bool> bit;
  if (is_about(high_ns_, 400) && (silence || is_about(low_ns_, 850))) bit = false;
  if (is_about(high_ns_, 800) && (silence || is_about(low_ns_, 450))) bit = true;
  disturbed_ += bit ? 0 : 1;
  bits_.push_back(bit.value_or(false));
  high_ns_ = 0;
}

// Green comes first, most significant bit first. A light that has not received all of its bits does not change.
void Ws2812Chain::end_picture() {
  if (bits_.empty()) return;
  ++pictures_;
  for (std::size_t light = 0; light < shown_.size(); ++light) {
    if (bits_.size() < (light + 1) * kBitsOfLight) break;
    std::uint32_t color = 0;
    for (unsigned bit = 0; bit < kBitsOfLight; ++bit)
      color = color << 1 | (bits_[light * kBitsOfLight + bit] ? 1U : 0U);
    shown_[light] = (color & 0x00'FF00) << 8 | (color & 0xFF'0000) >> 8 | (color & 0x00'00FF);
  }
  bits_.clear();
}

}  // namespace robosync::tests
