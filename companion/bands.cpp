// See bands.hpp.
#include "companion/bands.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace robosync::companion {
namespace {

constexpr double kLowest = 120, kHighest = 5500;  // Hz
constexpr double kLess =
    0.95;  // pre-emphasis: in speech, low tones are louder but carry less information

double mel_of(double hertz) {
  return 2595 * std::log10(1 + hertz / 700);
}

double hertz_of(double mel) {
  return 700 * (std::pow(10, mel / 2595) - 1);
}

}  // namespace

Bands::Bands() {
  for (std::size_t i = 0; i < kWindow; ++i)
    shape_[i] =
        0.54 - 0.46 * std::cos(2 * std::numbers::pi * static_cast<double>(i) / (kWindow - 1));
  for (std::size_t i = 0; i < kHalf; ++i)
    turns_[i] = std::polar(1.0, -2 * std::numbers::pi * static_cast<double>(i) / kWindow);
  const double low = mel_of(kLowest), step = (mel_of(kHighest) - low) / (kBands + 1);
  std::size_t least = 1;
  for (std::size_t i = 0; i < edges_.size(); ++i) {
    const double hertz = hertz_of(low + step * static_cast<double>(i));
    edges_[i] = std::max(least, static_cast<std::size_t>(hertz * kWindow / kSoundRate + 0.5));
    least = edges_[i] + 1;
  }
}

Levels Bands::hear(std::span<const std::int16_t, kHop> block) {
  std::copy(past_.begin() + kHop, past_.end(), past_.begin());
  for (std::size_t i = 0; i < kHop; ++i) {
    past_[kHop + i] = block[i] - kLess * last_;
    last_ = block[i];
  }
  for (std::size_t i = 0; i < kWindow; ++i)
    tones_[i] = past_[i] * shape_[i];
  transform();
  Levels levels;
  for (std::size_t band = 0; band < kBands; ++band) {
    const std::size_t left = edges_[band], middle = edges_[band + 1], right = edges_[band + 2];
    double power = 1;
    for (std::size_t i = left; i < right; ++i) {
      const std::size_t from = i <= middle ? i - left : right - i;
      const std::size_t width = i <= middle ? middle - left : right - middle;
      power += std::norm(tones_[i]) * static_cast<double>(from) / static_cast<double>(width);
    }
    levels[band] =
        static_cast<std::uint8_t>(std::clamp(20 * std::log10(power / kWindow), 0.0, 255.0));
  }
  return levels;
}

// The fast Fourier transform of Cooley and Tukey, in place.
void Bands::transform() {
  for (std::size_t i = 1, j = 0; i < kWindow; ++i) {
    std::size_t bit = kHalf;
    for (; (j & bit) != 0; bit >>= 1U)
      j ^= bit;
    j ^= bit;
    if (i < j) std::swap(tones_[i], tones_[j]);
  }
  for (std::size_t half = 1; half < kWindow; half *= 2)
    for (std::size_t begin = 0; begin < kWindow; begin += 2 * half)
      for (std::size_t i = 0; i < half; ++i) {
        const std::complex<double> a = tones_[begin + i];
        const std::complex<double> b = tones_[begin + i + half] * turns_[i * (kHalf / half)];
        tones_[begin + i] = a + b;
        tones_[begin + i + half] = a - b;
      }
}

}  // namespace robosync::companion
