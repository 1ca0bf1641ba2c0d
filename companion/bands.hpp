// Sound as loudness in frequency bands that match the ear's resolution (the mel scale: S. Davis and P. Mermelstein,
// "Comparison of parametric representations for monosyllabic word recognition", IEEE Trans. ASSP 28 (1980), section II).
#pragma once

#include <complex>
#include <cstddef>
#include <cstdint>
#include <span>

#include "companion/sound_source.hpp"
#include "companion/words_file.hpp"

namespace robosync::companion {

constexpr std::size_t kHop = 256;  // samples: 16 ms
constexpr long kHopMs = kHop * 1000 / kSoundRate;

class Bands {
public:
  Bands();
  // The levels of this block and the one before it, in half decibels above the softest.
  [[nodiscard]] Levels hear(std::span<const std::int16_t, kHop> block);

private:
  static constexpr std::size_t kWindow = 2 * kHop, kHalf = kWindow / 2;
  void transform();

  std::array<double, kWindow> past_{}, shape_{};
  std::array<std::complex<double>, kWindow> tones_{};
  std::array<std::complex<double>, kHalf> turns_{};
  std::array<std::size_t, kBands + 2>
      edges_{};  // of the bands, indices in tones_: each band reaches to the middles of its neighbours
  double last_ = 0;
};

}  // namespace robosync::companion
