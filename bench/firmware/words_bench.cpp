// Runs own_words block by block between markers: something as long as a word can be is said, and compared with samples of all
// lengths. It must be taken for the right one.
#include <array>
#include <cstddef>
#include <cstdint>

#include "bench/firmware/mark.hpp"
#include "runtime-m4/algorithms/modules.hpp"
#include "runtime-m4/algorithms/own_words.h"

namespace robosync::bench {
namespace {

constexpr std::uint32_t kSamples = 20, kQuiet = 200;
constexpr std::uint32_t kLoudest = 45, kRoom = 6;

// Two loud bands that move, from the beginning to the end of a word.
own_words_frame said(std::uint32_t at, std::uint32_t of) {
  own_words_frame frame{};
  for (std::uint32_t band = 0; band < OWN_WORDS_BANDS; ++band) {
    const std::uint32_t low = 2 + 5 * at / of, high = 16 - 7 * at / of;
    const std::uint32_t near =
        band < 9 ? (band - low) * (band - low) : 3 + (band - high) * (band - high);
    const std::uint32_t level = near < kLoudest - kRoom ? kLoudest - near : kRoom;
    frame.values[band / 5] |= level << (band % 5 * 6);
  }
  return frame;
}

own_words_frame room() {
  own_words_frame frame{};
  for (std::uint32_t band = 0; band < OWN_WORDS_BANDS; ++band)
    frame.values[band / 5] |= kRoom << (band % 5 * 6);
  return frame;
}

std::array<std::int32_t, kSamples*(1 + OWN_WORDS_VALUES * OWN_WORDS_MOST_FRAMES)> constants;
std::uint32_t count = 0;

void teach(std::uint32_t word, std::uint32_t frames) {
  constants[count++] = own_words_header(word, frames, OWN_WORDS_MOST_DISTANCE);
  for (std::uint32_t i = 0; i < frames; ++i) {
    const own_words_frame frame = said(i, frames);
    for (std::uint32_t v = 0; v < OWN_WORDS_VALUES; ++v) {
      std::uint32_t below = 0;
      for (std::uint32_t shift = 0; shift < 30; shift += 6)
        below |= (kLoudest - (frame.values[v] >> shift & 63)) << shift;
      constants[count++] = static_cast<std::int32_t>(below);
    }
  }
}

alignas(8) std::array<std::byte, 10'000> state;
constexpr std::array<std::int32_t, 2> kConfig = {50'000, 500};
std::int32_t word = ROBOSYNC_UNKNOWN;

void hear(const own_words_frame& frame) {
  std::array<std::int32_t, OWN_WORDS_VALUES> inputs{};
  for (std::size_t i = 0; i < inputs.size(); ++i)
    inputs[i] = static_cast<std::int32_t>(frame.values[i]);
  const robosync_block block = {inputs.data(), &word, kConfig.data()};
  robosync_show(reinterpret_cast<robosync_taught*>(state.data()), constants.data(), count);
  BENCH_MARK(words_begin);
  own_words_module.process(state.data(), nullptr, &block);
  BENCH_MARK(words_end);
}

bool measure() {
  if (own_words_module.state_bytes(kConfig.data()) > state.size()) return false;
  own_words_module.init(state.data(), kConfig.data(), 20);
  for (std::uint32_t i = 0; i < kSamples; ++i)
    teach(i, OWN_WORDS_MOST_FRAMES - 2 * i);
  for (std::uint32_t i = 0; i < kQuiet; ++i)
    hear(room());
  for (std::uint32_t i = 0; i < OWN_WORDS_MOST_FRAMES - 6; ++i)
    hear(said(i, OWN_WORDS_MOST_FRAMES - 6));
  for (std::uint32_t i = 0; i < kQuiet; ++i) {
    hear(room());
    if (word > 0) return true;
  }
  return false;
}

}  // namespace
}  // namespace robosync::bench

int main() {
  robosync::bench::leave(robosync::bench::measure());
}
