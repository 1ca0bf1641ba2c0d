// The ear's results for known sounds.
#include "runtime-m4/drivers/ear.hpp"

#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include <catch2/catch.hpp>

using namespace robosync;
using drivers::Ear;
using drivers::Heard;
using drivers::kEarBlock;

namespace {

using Block = std::array<std::int16_t, kEarBlock>;

// Plays `blocks` blocks of the sound in a row; returns what is heard in the last one.
template <class Sound>
Heard after(int blocks, Sound sound) {
  Ear ear;
  Heard heard;
  int at = 0;
  for (int b = 0; b < blocks; ++b) {
    Block block;
    for (std::int16_t& value : block)
      value = static_cast<std::int16_t>(sound(at++));
    heard = ear.hear(block);
  }
  return heard;
}

Heard tone(double hertz, double height) {
  return after(4, [=](int i) {
    return height * std::sin(2 * std::numbers::pi * hertz * i / drivers::kEarRate);
  });
}

// A sound with these harmonics.
Heard made_of(double hertz, std::initializer_list<double> heights) {
  return after(4, [=](int i) {
    double sum = 0, number = 0;
    for (const double height : heights) {
      number += 1;
      const double turns = hertz * number * i / drivers::kEarRate;
      sum += height * std::sin(2 * std::numbers::pi * turns + number * number);
    }
    return 5000 * sum;
  });
}

}  // namespace

TEST_CASE("loudness is that of the mean square, in decibels") {
  CHECK(after(2, [](int) { return 0; }).loudness == 0);
  CHECK(after(2, [](int) { return 1; }).loudness == 0);
  for (const int height : {2, 10, 100, 3000, 32767}) {
    INFO(height);
    const double expected = 20 * std::log10(height);
    CHECK(
        std::abs(after(2, [=](int i) { return i % 2 == 0 ? height : -height; }).loudness / 1000.0 -
                 expected) <= 0.6);
  }
  // Twice the height is 6 dB more; a slow change has few high tones.
  CHECK(tone(200, 2000).loudness - tone(200, 1000).loudness == 6000);
  CHECK(tone(100, 8000).highs < tone(100, 8000).loudness - 15'000);
}

TEST_CASE("the loudest and strangest sounds are no trouble") {
  constexpr int kLow = std::numeric_limits<std::int16_t>::min(),
                kHigh = std::numeric_limits<std::int16_t>::max();
  const Heard square = after(4, [](int i) { return i % 2 == 0 ? kLow : kHigh; });
  CHECK(square.loudness == 90'000);
  CHECK(square.highs == 96'000);
  const Heard slow = after(4, [](int i) { return i / 20 % 2 == 0 ? kLow : kHigh; });
  CHECK(std::abs(slow.pitch - 200'000) <= 1000);
  CHECK(after(4, [](int) { return kLow; }).loudness == 90'000);
}

TEST_CASE("a tone has its pitch to a hundredth, deep voices and whistles alike") {
  for (double hertz = 81; hertz < 2020; hertz *= 1.013) {
    INFO(hertz);
    const Heard heard = tone(hertz, 5000);
    CHECK(std::abs(heard.pitch / 1000.0 - hertz) <= hertz / (hertz < 500 ? 250 : 100));
    CHECK(heard.pitch % 100 == 0);
    CHECK(heard.pitch <= 2'000'000);
    CHECK(heard.clarity >= 90'000);
    CHECK(heard.clarity <= 100'000);
  }
}

TEST_CASE("a sound that is nearly there again after half its time has the pitch of the whole") {
  // Two tones an octave apart: shifted by half the lower one's period, the sound resembles itself the more, the louder the higher
  // one is.
  for (double hertz = 90; hertz < 400; hertz *= 1.031) {
    INFO(hertz);
    const Heard heard = made_of(hertz, {0.45, 1});  // 0.66
    CHECK(std::abs(heard.pitch / 1000.0 - hertz) <= hertz / 100);
  }
}

TEST_CASE("a sound has the pitch at which it is there again, whatever it is made of") {
  for (double hertz = 82; hertz < 520; hertz *= 1.021) {
    INFO(hertz);
    for (const Heard& heard : {made_of(hertz, {1, 0.5, 0.3, 0.25, 0.2, 0.15}),
                               made_of(hertz, {0, 1, 0.7, 0.5, 0.3}),  // its lowest tone is missing
                               made_of(hertz, {0.5, 1, 0.3, 0.2, 0.2}),    // an octave is louder
                               made_of(hertz, {1, 0, 0.3, 0, 0.2, 0})}) {  // as a clarinet
      CHECK(std::abs(heard.pitch / 1000.0 - hertz) <= hertz / 100);
      CHECK(heard.clarity >= 75'000);
    }
  }
}

TEST_CASE("noise and silence have no pitch that is clear") {
  std::minstd_rand random(1);
  for (int i = 0; i < 20; ++i) {
    const Heard noise = after(4, [&](int) { return static_cast<int>(random() % 8001) - 4000; });
    CHECK(noise.clarity < 60'000);
    CHECK(std::abs(noise.highs - noise.loudness - 3000) <= 1000);
  }
  CHECK(after(4, [](int i) { return i % 3; }).clarity == 0);
}
