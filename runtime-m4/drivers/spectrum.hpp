// What modules that recognise words get of a sound: how loud each of 20 bands is, from 100 Hz to 3.8 kHz, which are as wide as the
// ear resolves (the mel scale: S. Davis and P. Mermelstein, "Comparison of parametric representations for monosyllabic word
// recognition", IEEE Trans. ASSP 28 (1980), section II). Integers only, so the result is the same everywhere.
//
// A level counts steps of 1.505 dB, a factor of the square root of two in power, from 0 to 63.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "vm/value.hpp"

namespace robosync::drivers {

inline constexpr std::size_t kBands = 20, kBandBits = 6;
// Five levels in each value, the lowest band in the lowest bits: the channels BANDS_1 … BANDS_4.
inline constexpr std::size_t kBandsInValue = 5;
using BandValues = std::array<vm::Value, kBands / kBandsInValue>;

inline constexpr std::size_t kSpectrumWindow = 256;
// Of the window's samples, and of the one before them, at 8,000 a second. `work` is overwritten.
[[nodiscard]] BandValues bands_of(std::span<const std::int16_t, kSpectrumWindow + 1> samples,
                                  std::span<std::int16_t, kSpectrumWindow> work);

}  // namespace robosync::drivers
