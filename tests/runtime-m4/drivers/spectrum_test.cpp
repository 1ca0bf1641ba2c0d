// The spectrum of a microphone's sound, against a Fourier transform in floating point.
#include "runtime-m4/drivers/spectrum.hpp"

#include <cmath>
#include <complex>
#include <numbers>
#include <random>

#include <catch2/catch.hpp>

using namespace robosync;
using drivers::kBands;

namespace {

constexpr std::size_t kWindow = drivers::kSpectrumWindow;
using Samples = std::array<std::int16_t, kWindow + 1>;
using Levels = std::array<int, kBands>;

Levels levels_of(const Samples& samples) {
  std::array<std::int16_t, kWindow> work;
  const drivers::BandValues values = drivers::bands_of(samples, work);
  Levels levels{};
  for (std::size_t band = 0; band < kBands; ++band)
    levels[band] = values[band / 5] >> (band % 5 * 6) & 63;
  return levels;
}

double hertz(double band) {
  const auto mel = [](double f) { return 2595 * std::log10(1 + f / 700); };
  const double step = (mel(3850) - mel(100)) / (kBands + 1);
  return 700 * (std::pow(10, (mel(100) + step * band) / 2595) - 1);
}

// In steps of a factor of the square root of two in power; the middles of the bands are whole parts of 31.25 Hz.
Levels naive(const Samples& samples) {
  std::array<double, kWindow> window{};
  for (std::size_t i = 0; i < kWindow; ++i)
    window[i] = (samples[i + 1] - 0.9375 * samples[i]) *
                (0.54 - 0.46 * std::cos(2 * std::numbers::pi * static_cast<double>(i) / kWindow));
  std::array<double, kWindow / 2> power{};
  for (std::size_t tone = 0; tone < power.size(); ++tone) {
    std::complex<double> sum;
    for (std::size_t i = 0; i < kWindow; ++i)
      sum += window[i] *
             std::polar(1.0, -2 * std::numbers::pi * static_cast<double>(i * tone) / kWindow);
    power[tone] = std::norm(sum);
  }
  Levels levels{};
  for (std::size_t band = 0; band < kBands; ++band) {
    const auto edge = [&](std::size_t i) {
      return std::round(hertz(static_cast<double>(i)) * kWindow / 8000);
    };
    const double left = edge(band), middle = edge(band + 1), right = edge(band + 2);
    double sum = 0;
    for (std::size_t tone = 0; tone < power.size(); ++tone) {
      const auto at = static_cast<double>(tone);
      const double weight =
          std::min((at - left) / (middle - left), (right - at) / (right - middle));
      sum += power[tone] * std::max(weight, 0.0);
    }
    levels[band] = std::max(0, static_cast<int>(std::floor(2 * std::log2(sum + 1) - 22)));
  }
  return levels;
}

Samples tone(double frequency, double height) {
  Samples samples;
  for (std::size_t i = 0; i < samples.size(); ++i)
    samples[i] = static_cast<std::int16_t>(
        height * std::sin(2 * std::numbers::pi * frequency * static_cast<double>(i) / 8000));
  return samples;
}

std::size_t loudest(const Levels& levels) {
  return static_cast<std::size_t>(std::ranges::max_element(levels) - levels.begin());
}

}  // namespace

TEST_CASE("spectrum: a tone is loudest in its band, however loud it is") {
  for (std::size_t band = 0; band < kBands; ++band)
    for (const double height : {300.0, 3000.0, 32'000.0})
      CHECK(loudest(levels_of(tone(hertz(static_cast<double>(band + 1)), height))) == band);
}

TEST_CASE("spectrum: noise, tones and both are what a Fourier transform says, within a level") {
  std::mt19937 draw(1);
  for (int round = 0; round < 60; ++round) {
    const double height = std::exp2(4 + static_cast<int>(draw() % 10));
    const double hiss = std::exp2(2 + static_cast<int>(draw() % 11));
    std::normal_distribution<double> noise(0, hiss);
    Samples samples = tone(100 + static_cast<int>(draw() % 3700), round % 3 == 0 ? 0 : height);
    for (std::int16_t& sample : samples)
      sample = static_cast<std::int16_t>(std::clamp(sample + noise(draw), -32768.0, 32767.0));
    const Levels got = levels_of(samples), wanted = naive(samples);
    const int deepest = *std::ranges::max_element(wanted) - 30;  // softer is not used
    for (std::size_t band = 0; band < kBands; ++band) {
      INFO("round " << round << " band " << band);
      CHECK(std::max(got[band], deepest) <= std::max(wanted[band], deepest) + 1);
      CHECK(std::max(got[band], deepest) >= std::max(wanted[band], deepest) - 1);
    }
  }
}

TEST_CASE("spectrum: silence has no level, and the largest jumps break nothing") {
  CHECK(levels_of({}) == Levels{});
  Samples samples;
  for (std::size_t i = 0; i < samples.size(); ++i)
    samples[i] = i % 2 == 0 ? INT16_MIN : INT16_MAX;
  CHECK(levels_of(samples)[kBands - 1] < 63);
  for (std::size_t i = 0; i < samples.size(); ++i)
    samples[i] = i % 40 < 20 ? INT16_MIN : INT16_MAX;
  CHECK(levels_of(samples)[0] > 50);
}
