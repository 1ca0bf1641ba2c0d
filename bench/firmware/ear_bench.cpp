// Runs the ear, and its spectrum, block by block between markers: tones of all pitches that it knows, with noise. It must find most of them, so that
// the count is not that of the early return for silence.
#include <array>
#include <cstddef>
#include <cstdint>

#include "bench/firmware/mark.hpp"
#include "runtime-m4/drivers/ear.hpp"

namespace robosync::bench {
namespace {

drivers::Ear ear;
drivers::BandValues spectrum;
std::array<std::int16_t, drivers::kEarBlock> block;
std::uint32_t random = 1;

// A sawtooth with a period of this many samples, plus noise.
void fill(std::int32_t period) {
  static std::int32_t at = 0;
  for (std::int16_t& sample : block) {
    at = (at + 1) % period;
    random = random * 1'664'525 + 1'013'904'223;
    const auto noise = static_cast<std::int32_t>(random >> 22);
    sample = static_cast<std::int16_t>(at * 20'000 / period - 10'000 + noise);
  }
}

drivers::Heard hear() {
  BENCH_MARK(ear_begin);
  const drivers::Heard heard = ear.hear(block);
  BENCH_MARK(ear_end);
  return heard;
}

void see() {
  BENCH_MARK(spectrum_begin);
  spectrum = ear.bands();
  BENCH_MARK(spectrum_end);
}

bool measure() {
  int found = 0;
  constexpr std::int32_t kShortest = 4, kLongest = 100, kBlocks = 4;
  for (std::int32_t period = kShortest; period <= kLongest; ++period)
    for (int i = 0; i < kBlocks; ++i) {
      fill(period);
      const vm::Value hertz = hear().pitch / vm::kScale * period;
      constexpr vm::Value kRate = drivers::kEarRate, kFar = kRate / 20;
      see();
      if (hertz > kRate - kFar && hertz < kRate + kFar) ++found;
    }
  return found > (kLongest - kShortest) * kBlocks / 2;
}

}  // namespace
}  // namespace robosync::bench

int main() {
  robosync::bench::leave(robosync::bench::measure());
}
