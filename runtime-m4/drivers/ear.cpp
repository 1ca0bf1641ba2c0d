#include "runtime-m4/drivers/ear.hpp"

#include <algorithm>
#include <bit>
#include <utility>

namespace robosync::drivers {
namespace {

// Lags between two repetitions, in samples.
constexpr std::size_t kShortest = kEarRate / 2000;
constexpr std::size_t kMiddle = 16;  // up to here in all samples, from here on in every second one
constexpr std::size_t kLongest = kEarRate / 2 / 80;  // … counted in those
// How many samples are compared: at the longest lag, one and a half repetitions.
constexpr std::size_t kCompared = 96, kComparedHalved = 80;
constexpr vm::Value kHighest = 20'000;  // in tenths of a Hz
constexpr std::int32_t kEnough = 82;    // % of the highest similarity: this much is a repetition
constexpr std::int32_t kLeastEnergy = 100;  // a sample's mean square: softer sound has no pitch
constexpr std::int32_t kHeight =
    1 << 11;  // samples are scaled below this to compare them: then a block of squares fits

// 10 lg(square), in whole dB: 3.0103 times the logarithm to base 2. Its integer part is the highest bit; each of the ten bits of
// its fraction is whether the square of the remainder reaches 2.
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

using Samples = std::span<const std::int16_t>;

// Halves the samples until all are below kHeight.
void soften(std::span<std::int16_t> samples) {
  std::int32_t highest = 0;
  for (const std::int32_t sample : samples)
    highest = std::max(highest, sample < 0 ? -sample : sample);
  int shift = 0;
  while (highest >> shift >= kHeight)
    ++shift;
  for (std::int16_t& sample : samples)
    sample = static_cast<std::int16_t>(sample >> shift);
}

// The similarity of a sound that repeats exactly.
constexpr std::int32_t kAlike = 1 << 14;

// How similar the last `compared` samples are to those `lag` samples earlier, in parts of kAlike. Each call of next() goes on to
// the next lag.
class Comparison {
public:
  Comparison(Samples samples, std::size_t compared, std::size_t first_lag)
      : latest_(samples.last(compared)),
        begin_(latest_.data() - first_lag),
        latest_energy_(energy(latest_)),
        earlier_energy_(energy({begin_, compared})) {}

  std::int32_t next() {
    const std::int32_t product = products(latest_, begin_);
    const std::int32_t energy = latest_energy_ + earlier_energy_;
    --begin_;
    const std::int32_t gained = begin_[0], lost = begin_[latest_.size()];
    earlier_energy_ += gained * gained - lost * lost;
    if (energy / 2 < kLeastEnergy * static_cast<std::int32_t>(latest_.size())) return 0;
    // Shifted so that its highest bit is always in the same place: 15 bits below it are exact. Never 0.
    const int room = std::countl_zero(static_cast<std::uint32_t>(energy)) - 1;
    const std::int32_t whole = (energy << room) / (2 * kAlike);
    return (product << room) / whole;  // NOLINT(clang-analyzer-core.DivideZero)
  }

private:
  // For a multiple of eight samples: most of the work is here.
  static std::int32_t products(Samples some, const std::int16_t* others) {
    std::int32_t sum = 0;
    const std::int16_t* const end = some.data() + some.size();
    for (const std::int16_t* one = some.data(); one != end; one += 8, others += 8) {
      sum += one[0] * others[0] + one[1] * others[1] + one[2] * others[2] + one[3] * others[3];
      sum += one[4] * others[4] + one[5] * others[5] + one[6] * others[6] + one[7] * others[7];
    }
    return sum;
  }
  static std::int32_t energy(Samples samples) { return products(samples, samples.data()); }

  Samples latest_;
  const std::int16_t* begin_;  // of the samples that they are compared with
  std::int32_t latest_energy_, earlier_energy_;
};

constexpr std::int32_t kPart = 256;

}  // namespace

// The peaks of a sound, shorter lags first.
struct Ear::Peaks {
  void find(Samples samples, std::size_t compared, std::size_t first_lag, std::size_t last_lag,
            std::int32_t samples_each) {
    Comparison comparison(samples, compared, first_lag);
    std::int32_t left = comparison.next(), middle = comparison.next();
    for (std::size_t lag = first_lag + 2; lag <= last_lag; ++lag) {
      const std::int32_t right = comparison.next();
      if (middle > left && middle >= right && count < all.size()) {
        const Peak peak = between(left, middle, right, lag - 1);
        highest = std::max(highest, peak.height);
        all[count++] = {peak.lag * samples_each, peak.height};
      }
      left = middle;
      middle = right;
    }
  }

  // The peak of a parabola through three neighbours, of which the middle one is the highest.
  static Peak between(std::int32_t left, std::int32_t middle, std::int32_t right, std::size_t lag) {
    const std::int32_t bend = 2 * middle - left - right, slope = right - left;
    const std::int32_t offset = bend > 0 ? slope * (kPart / 2) / bend : 0;
    return {static_cast<std::int32_t>(lag) * kPart + offset, middle + slope * offset / (4 * kPart)};
  }

  std::array<Peak, 32>& all;
  std::size_t count = 0;
  std::int32_t highest = 0;
};

Heard Ear::hear(std::span<const std::int16_t, kEarBlock> block) {
  std::ranges::copy(block, next().begin());
  return hear_next();
}

std::span<std::int16_t, kEarBlock> Ear::next() {
  std::copy(past_.begin() + kEarBlock, past_.end(), past_.begin());
  return std::span(past_).last<kEarBlock>();
}

void Ear::forget() {
  past_.fill(0);
  follows_ = false;
}

Heard Ear::hear_next() {
  const std::span<const std::int16_t, kEarBlock> block = std::span(past_).last<kEarBlock>();
  if (!std::exchange(follows_, true)) last_ = block[0];
  std::uint64_t squares = 0, differences = 0;
  for (const std::int16_t sample : block) {
    const std::int64_t difference = std::int64_t{sample} - last_;
    squares += static_cast<std::uint64_t>(std::int64_t{sample} * sample);
    differences += static_cast<std::uint64_t>(difference * difference);
    last_ = sample;
  }
  Heard heard;
  heard.loudness = decibel(squares / kEarBlock);
  heard.highs = decibel(differences / kEarBlock);
  find_pitch(heard);
  return heard;
}

// What repeats after some lag also repeats after twice that lag, so the first of the highest peaks is taken.
void Ear::find_pitch(Heard& heard) {
  work_ = past_;
  soften(work_);
  Peaks peaks{peaks_};
  peaks.find(work_, kCompared, kShortest - 1, kMiddle + 2, 1);
  const std::span<std::int16_t> halved = std::span(work_).first<kPast / 2>();
  for (std::size_t i = 0; i < halved.size(); ++i)
    halved[i] = static_cast<std::int16_t>((work_[2 * i] + work_[2 * i + 1]) / 2);
  peaks.find(halved, kComparedHalved, kMiddle / 2, kLongest + 1, 2);
  const std::int32_t enough = peaks.highest * kEnough / 100;
  if (enough <= 0) return;
  const Peak first = *std::find_if(peaks_.begin(), peaks_.end(),
                                   [&](const Peak& peak) { return peak.height >= enough; });
  const vm::Value tenths = std::int32_t{kEarRate} * 10 * kPart / first.lag;
  heard.pitch = std::min(tenths, kHighest) * (vm::kScale / 10);
  heard.clarity = first.height * 100 / kAlike * vm::kScale;
}

}  // namespace robosync::drivers
