#include "runtime-m4/drivers/ear.hpp"

#include <algorithm>

namespace robosync::drivers {
namespace {

constexpr unsigned kHalfRate = kEarRate / 2;
constexpr std::size_t kShortest = kHalfRate / 500,
                      kLongest = kHalfRate / 80;  // samples between repetitions
constexpr std::int64_t kLeastEnergy =
    100;  // of a sample's square, on average: what is softer has no pitch

// 10 lg(square), in whole dB: 3.0103 times the logarithm to base 2, which is its highest bit and, for the fraction, ten times
// whether the square of what remains reaches 2.
vm::Value decibel(std::uint64_t square) {
  if (square == 0) return 0;
  unsigned exponent = 0;
  while (square >> exponent > 1)
    ++exponent;
  constexpr unsigned kBits = 10, kFine = 30;
  std::uint64_t remains =
      exponent >= kFine ? square >> (exponent - kFine) : square << (kFine - exponent);
  std::uint64_t logarithm = exponent;
  for (unsigned bit = 0; bit < kBits; ++bit) {
    remains = remains * remains >> kFine;
    const bool reaches = remains >> (kFine + 1) != 0;
    logarithm = logarithm << 1 | (reaches ? 1U : 0U);
    if (reaches) remains >>= 1;
  }
  constexpr std::uint64_t kPerOctave = 30103;  // ten thousandths of a dB
  const std::uint64_t tenths = (logarithm * kPerOctave >> kBits) / 1000;
  return static_cast<vm::Value>((tenths + 5) / 10) * vm::kScale;
}

}  // namespace

Heard Ear::hear(std::span<const std::int16_t, kEarBlock> block) {
  std::uint64_t squares = 0, differences = 0;
  for (const std::int16_t sample : block) {
    const std::int64_t difference = std::int64_t{sample} - last_;
    squares += static_cast<std::uint64_t>(std::int64_t{sample} * sample);
    differences += static_cast<std::uint64_t>(difference * difference);
    last_ = sample;
  }
  remember(block);
  Heard heard;
  heard.loudness = decibel(squares / kEarBlock);
  heard.highs = decibel(differences / kEarBlock);
  find_pitch(heard);
  return heard;
}

void Ear::remember(std::span<const std::int16_t, kEarBlock> block) {
  std::copy(past_.begin() + kHalf, past_.end(), past_.begin());
  for (std::size_t i = 0; i < kHalf; ++i)
    past_[kHalf + i] = static_cast<std::int16_t>((block[2 * i] + block[2 * i + 1]) / 2);
}

// How much of it is there again so many samples later, in thousandths of what is there. What changes slowly is like itself a moment
// later, too: so only what comes after the likeness has grown counts. The first of the highest ones is taken, not half its pitch.
void Ear::find_pitch(Heard& heard) const {
  std::int64_t best = 0, last = vm::kScale;
  std::size_t best_at = 0;
  bool has_grown = false;
  for (std::size_t lag = kShortest - 1; lag <= kLongest; ++lag) {
    const std::int64_t share = likeness(lag);
    has_grown = has_grown || share > last;
    last = share;
    if (!has_grown || share <= best + best / 10) continue;
    best = share;
    best_at = lag;
  }
  if (best_at < kShortest) return;
  heard.pitch = static_cast<vm::Value>(kHalfRate / best_at) * vm::kScale;
  heard.clarity = static_cast<vm::Value>(best / 10) * vm::kScale;
}

std::int64_t Ear::likeness(std::size_t lag) const {
  constexpr std::size_t kCompared = 2 * kHalf - kLongest;
  std::int64_t product = 0, energy = 0;
  for (std::size_t i = 0; i < kCompared; ++i) {
    const std::int64_t a = past_[i], b = past_[i + lag];
    product += a * b;
    energy += a * a + b * b;
  }
  if (energy / 2 < kLeastEnergy * static_cast<std::int64_t>(kCompared)) return 0;
  return product * 2 * vm::kScale / energy;
}

}  // namespace robosync::drivers
