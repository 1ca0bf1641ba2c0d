// Numbers as if at random, the same in every run.
#pragma once

#include <cstdint>

// Marsaglia's xorshift32: the next state.
constexpr std::uint32_t xorshift32(std::uint32_t state) {
  state ^= state << 13;
  state ^= state >> 17;
  state ^= state << 5;
  return state;
}

class Draw {
public:
  explicit constexpr Draw(std::uint32_t seed) : state_(seed) {}
  std::uint32_t below(std::uint32_t limit) {
    state_ = xorshift32(state_);
    return (state_ >> 8) % limit;
  }
  // Of any magnitude below 2^bits.
  std::uint32_t of_any_size(std::uint32_t bits) { return below(1U << (1 + below(bits))); }

private:
  std::uint32_t state_;
};
