// See spectrum.hpp. A window of 256 real samples is transformed as 128 complex ones (J. W. Cooley and J. W. Tukey, 1965), halved in
// each of the seven stages, so that 16 bits hold every result. So that a soft sound keeps its bits, it is doubled first as often as
// it can be.
#include "runtime-m4/drivers/spectrum.hpp"

#include <algorithm>
#include <bit>

namespace robosync::drivers {
namespace {

constexpr std::size_t kPairs = kSpectrumWindow / 2, kStages = 7;
constexpr int kOne = 15;                   // bits of a fraction
constexpr std::int32_t kHeight = 1 << 14;  // samples stay below this
constexpr int kWeightBits = 8;
// The level of the sound that leaves 16 bits' last one trembling is about 0.
constexpr int kSoftest = 22;

// sin(2 pi i / 256).
constexpr std::array<std::int16_t, kSpectrumWindow / 4 + 1> kSines = {
    0,     804,   1608,  2411,  3212,  4011,  4808,  5602,  6393,  7180,  7962,  8740,  9512,
    10279, 11039, 11793, 12540, 13279, 14010, 14733, 15447, 16151, 16846, 17531, 18205, 18868,
    19520, 20160, 20788, 21403, 22006, 22595, 23170, 23732, 24279, 24812, 25330, 25833, 26320,
    26791, 27246, 27684, 28106, 28511, 28899, 29269, 29622, 29957, 30274, 30572, 30853, 31114,
    31357, 31581, 31786, 31972, 32138, 32286, 32413, 32522, 32610, 32679, 32729, 32758, 32767};

// Each band rises from the middle of the one below to its own, and falls to that of the one above; in parts of 31.25 Hz.
constexpr std::array<std::uint8_t, kBands + 2> kEdges = {
    3, 5, 8, 10, 13, 16, 20, 23, 27, 32, 36, 41, 47, 53, 59, 66, 74, 82, 91, 101, 112, 123};

struct Turn {
  std::int32_t cosine, sine;
};

// For i up to half a circle.
Turn turn(std::size_t i) {
  constexpr std::size_t kQuarter = kSpectrumWindow / 4;
  if (i <= kQuarter) return {kSines[kQuarter - i], kSines[i]};
  return {-kSines[i - kQuarter], kSines[2 * kQuarter - i]};
}

using Work = std::span<std::int16_t, kSpectrumWindow>;

// Low tones are louder but say less: what a sample differs from 15/16 of the one before.
std::int32_t emphasized(const std::int16_t* sample) {
  return sample[0] - sample[-1] + sample[-1] / 16;
}

// How often the samples can be doubled; negative: they are halved.
int room_of(std::span<const std::int16_t, kSpectrumWindow + 1> samples) {
  std::uint32_t highest = 1;
  for (std::size_t i = 1; i <= kSpectrumWindow; ++i) {
    const std::int32_t value = emphasized(&samples[i]);
    highest = std::max(highest, static_cast<std::uint32_t>(value < 0 ? -value : value));
  }
  return std::countl_zero(highest) - std::countl_zero(std::uint32_t{kHeight}) - 1;
}

// Hamming's window; pair i goes to the place whose number has the bits of i in reverse.
void fill(std::span<const std::int16_t, kSpectrumWindow + 1> samples, int room, Work work) {
  constexpr std::int32_t kMiddle = 17695, kSwing = 15073;  // 0.54, 0.46
  std::size_t place = 0;
  for (std::size_t i = 0; i < kSpectrumWindow; ++i) {
    const std::int32_t value = emphasized(&samples[i + 1]);
    const std::size_t from_end = i < kPairs ? i : kSpectrumWindow - 1 - i;
    const std::int32_t weight = kMiddle - (kSwing * turn(from_end).cosine >> kOne);
    const std::int32_t scaled = room < 0 ? value >> -room : value * (1 << room);
    work[2 * place + i % 2] = static_cast<std::int16_t>(scaled * weight >> kOne);
    if (i % 2 == 0) continue;
    std::size_t bit = kPairs / 2;
    for (; (place & bit) != 0; bit >>= 1U)
      place ^= bit;
    place |= bit;
  }
}

void combine(std::int16_t* a, std::int16_t* b, Turn by) {
  const std::int32_t real = (b[0] * by.cosine + b[1] * by.sine) >> kOne;
  const std::int32_t imaginary = (b[1] * by.cosine - b[0] * by.sine) >> kOne;
  const std::int32_t a_real = a[0] + 1, a_imaginary = a[1] + 1;
  a[0] = static_cast<std::int16_t>((a_real + real) >> 1);
  a[1] = static_cast<std::int16_t>((a_imaginary + imaginary) >> 1);
  b[0] = static_cast<std::int16_t>((a_real - real) >> 1);
  b[1] = static_cast<std::int16_t>((a_imaginary - imaginary) >> 1);
}

void transform(Work work) {
  for (std::size_t half = 1; half < kPairs; half *= 2)
    for (std::size_t i = 0; i < half; ++i) {
      const Turn by = turn(i * (kPairs / half));
      for (std::size_t begin = i; begin < kPairs; begin += 2 * half)
        combine(&work[2 * begin], &work[2 * (begin + half)], by);
    }
}

// The power of the real signal's tone i, 1 … 127.
std::uint32_t power(Work work, std::size_t i) {
  const std::int16_t* const one = &work[2 * i];
  const std::int16_t* const other = &work[2 * (kPairs - i)];
  const std::int32_t even_real = one[0] + other[0], even_imaginary = one[1] - other[1];
  const std::int32_t odd_real = one[1] + other[1], odd_imaginary = other[0] - one[0];
  const Turn by = turn(i);
  const std::int32_t real =
      (even_real + ((odd_real / 2 * by.cosine + odd_imaginary / 2 * by.sine) >> (kOne - 1))) / 2;
  const std::int32_t imaginary =
      (even_imaginary + ((odd_imaginary / 2 * by.cosine - odd_real / 2 * by.sine) >> (kOne - 1))) /
      2;
  return static_cast<std::uint32_t>(real * real) +
         static_cast<std::uint32_t>(imaginary * imaginary);
}

// Twice the logarithm to base 2, rounded down.
int steps(std::uint64_t sum) {
  constexpr std::uint64_t kRootOfTwo = 46341;  // in 2^-15
  const int exponent = static_cast<int>(std::bit_width(sum)) - 1;
  const std::uint64_t mantissa =
      exponent > kOne ? sum >> (exponent - kOne) : sum << (kOne - exponent);
  return 2 * exponent + (mantissa >= kRootOfTwo ? 1 : 0);
}

std::uint64_t sum_of(Work work, std::size_t band) {
  const std::uint32_t left = kEdges[band], middle = kEdges[band + 1], right = kEdges[band + 2];
  constexpr std::uint32_t kWhole = 1U << kWeightBits;
  std::uint64_t sum = 0;
  for (std::uint32_t i = left + 1, rise = kWhole / (middle - left); i <= middle; ++i) {
    const std::uint32_t weight = rise * (i - left);
    sum += std::uint64_t{power(work, i)} * weight;
  }
  for (std::uint32_t i = middle + 1, fall = kWhole / (right - middle); i < right; ++i) {
    const std::uint32_t weight = fall * (right - i);
    sum += std::uint64_t{power(work, i)} * weight;
  }
  return sum;
}

}  // namespace

BandValues bands_of(std::span<const std::int16_t, kSpectrumWindow + 1> samples, Work work) {
  const int room = room_of(samples);
  fill(samples, room, work);
  transform(work);
  const int scaled = 2 * kWeightBits + 4 * (room - static_cast<int>(kStages)) + kSoftest;
  constexpr int kMost = (1 << kBandBits) - 1;
  BandValues values{};
  for (std::size_t band = 0; band < kBands; ++band) {
    const std::uint64_t sum = sum_of(work, band);
    const int level = sum == 0 ? 0 : std::clamp(steps(sum) - scaled, 0, kMost);
    values[band / kBandsInValue] |= level << (band % kBandsInValue * kBandBits);
  }
  return values;
}

}  // namespace robosync::drivers
