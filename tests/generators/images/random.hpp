// Random numbers that are the same on every machine: the board draws its inputs as the host does.
#pragma once

#include <cstdint>

namespace robosync::fuzz {

// xorshift64*, started by way of splitmix64, so that seeds that follow each other share nothing.
class Random {
public:
  explicit Random(std::uint64_t seed) {
    seed += 0x9E3779B97F4A7C15;
    seed = (seed ^ seed >> 30) * 0xBF58476D1CE4E5B9;
    seed = (seed ^ seed >> 27) * 0x94D049BB133111EB;
    state_ = (seed ^ seed >> 31) | 1;
  }

  std::uint32_t next() {
    state_ ^= state_ >> 12;
    state_ ^= state_ << 25;
    state_ ^= state_ >> 27;
    return static_cast<std::uint32_t>(state_ * 0x2545F4914F6CDD1D >> 32);
  }
  // 0 … bound - 1; 0 where bound is 0.
  std::uint32_t below(std::uint64_t bound) {
    return static_cast<std::uint32_t>(std::uint64_t{next()} * static_cast<std::uint32_t>(bound) >>
                                      32);
  }
  bool one_in(std::uint32_t n) { return below(n) == 0; }

private:
  std::uint64_t state_;
};

}  // namespace robosync::fuzz
