// The parts of own_words: what counts as said, against frames that are counted by hand; cepstra and warping against the formulas of
// the papers, in floating point and without any bound on the work.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <random>
#include <vector>

#include <catch2/catch.hpp>

#include "runtime-m4/algorithms/own_words_ear.h"
#include "runtime-m4/algorithms/own_words_warp.h"

// Other tests of one program use these names, too.
namespace own_words_parts {
namespace {

constexpr int kBands = OWN_WORDS_BANDS;
using Levels = std::array<int, kBands>;

own_words_frame packed(const Levels& levels) {
  own_words_frame frame{};
  for (std::size_t band = 0; band < kBands; ++band)
    frame.values[band / 5] |= static_cast<std::uint32_t>(levels.at(band)) << (band % 5 * 6);
  return frame;
}

own_words_frame flat(int level) {
  Levels levels;
  levels.fill(level);
  return packed(levels);
}

// ---- what is said

struct Ear {
  Ear() { own_words_begin(&ear); }
  // What was said in the last frame.
  std::uint32_t hear(int level, int frames) {
    std::uint32_t said = 0;
    for (const own_words_frame frame = flat(level); frames > 0; --frames)
      said = own_words_hear(&ear, &frame);
    return said;
  }
  own_words_ear ear;
};

constexpr int kQuiet = 6, kVoice = 40;
// The three frames before a voice belong to what is said. Two after it are still loud, as the mean of three frames; the last one is
// left out. Then comes the pause.
constexpr std::uint32_t kBefore = 3, kAfter = 1;
constexpr int kStillLoud = 2, kPause = 15;

}  // namespace

TEST_CASE("own_words: what is said begins before the first loud frame, and is over after a pause") {
  Ear it;
  CHECK(it.hear(kQuiet, 40) == 0);
  it.ear.said_noise[0] = 0;
  CHECK(it.hear(kVoice, 1) == 0);
  CHECK(it.ear.talks == 0);
  CHECK(it.hear(kVoice, 29) == 0);
  CHECK(it.ear.talks == 1);
  CHECK(std::ranges::all_of(it.ear.said_noise, [](int noise) { return noise == kQuiet; }));
  CHECK(it.hear(kQuiet, kStillLoud + kPause - 1) == 0);
  REQUIRE(it.hear(kQuiet, 1) == kBefore + 30 + kAfter);
  for (std::uint32_t i = 0; i < kBefore + 30 + kAfter; ++i) {
    const bool quiet = i < kBefore || i >= kBefore + 30;
    CHECK(it.ear.said[i].values[0] == flat(quiet ? kQuiet : kVoice).values[0]);
  }
  CHECK(it.hear(kQuiet, 100) == 0);
}

TEST_CASE("own_words: what is as short as a word, or as long, is said; what is not is none") {
  const auto said = [](int frames) {
    Ear it;
    it.hear(kQuiet, 40);
    it.hear(kVoice, frames);
    const std::uint32_t count = it.hear(kQuiet, kStillLoud + kPause);
    return std::pair(count, it.ear.was_too_long != 0);
  };
  const int least = OWN_WORDS_LEAST_FRAMES - kAfter;
  const int most = OWN_WORDS_MOST_FRAMES - kBefore - kAfter;
  CHECK(said(least) == std::pair(kBefore + OWN_WORDS_LEAST_FRAMES, false));
  CHECK(said(least - 1) == std::pair(0U, false));
  CHECK(said(most) == std::pair(std::uint32_t{OWN_WORDS_MOST_FRAMES}, false));
  CHECK(said(most + 1) == std::pair(0U, true));
}

TEST_CASE("own_words: what lasts for 22 minutes with short breaks is too long, and no word") {
  Ear it;
  it.hear(kQuiet, 40);
  for (int break_ = 0; break_ < 0x1'0000 / 12 + 3; ++break_) {
    it.hear(kVoice, 6);
    CHECK(it.hear(kQuiet, 6) == 0);
  }
  CHECK(it.ear.talks == 1);
  CHECK(it.hear(kQuiet, kStillLoud + kPause - 6) == 0);
  CHECK(it.ear.talks == 0);
  CHECK(it.ear.was_too_long == 1);
}

TEST_CASE("own_words: a sound is loud from a level and some above the background on") {
  for (const int above : {2, 3}) {
    Ear it;
    it.hear(kQuiet, 40);
    it.hear(kQuiet + above, 3);
    CHECK(it.ear.talks == (above == 3));
  }
}

TEST_CASE(
    "own_words: the background is the softest fifth of three seconds, and not known at first") {
  Ear it;
  it.hear(kQuiet, 3);
  it.hear(kVoice, 9);
  CHECK(it.ear.talks == 0);
  for (const int soft : {30, 33}) {  // of 150 frames, each third one of which counts
    Ear other;
    other.hear(kQuiet, soft);
    other.hear(20, 150 - soft);
    CHECK(int{other.ear.noise[7]} == (soft == 30 ? 20 : kQuiet));
    other.hear(25, 117);
    CHECK(int{other.ear.noise[7]} == 20);
    other.hear(25, 3);
    CHECK(int{other.ear.noise[7]} == 25);
  }
  Ear silent;
  silent.hear(0, 60);
  CHECK(int{silent.ear.noise[0]} == 2);  // the last bit of a sample
}

namespace {

// ---- cepstra

// Levels of 1.5 dB: two of them are a factor of 2 in power.
double together(double a, double b) {
  return 2 * std::log2(std::exp2(a / 2) + std::exp2(b / 2));
}

using Cepstra = std::vector<std::array<double, OWN_WORDS_CEPSTRA>>;

constexpr double kSpeech = 27.0 / 16 * kBands;  // so far above the noise

struct Spoken {
  std::vector<Levels> frames;
  Levels noise{};
  int loudest = 0;
  bool is_sample = false;

  double raised(int noise_in_band) const { return noise_in_band + 1; }
  double level(const Levels& frame, std::size_t band) const {
    const double noise_here = raised(noise.at(band));
    return is_sample ? together(loudest - frame.at(band), noise_here)
                     : std::max<double>(frame.at(band), noise_here);
  }
  double above(const Levels& frame) const {
    double above = 0;
    for (std::size_t band = 0; band < kBands; ++band)
      above += std::max(
          0.0, level(frame, band) - std::max<double>(raised(noise.at(band)), loudest - 30));
    return above;
  }
  double audible(const Levels& frame, std::size_t band) const {
    return together(level(frame, band), std::max(loudest - 24, 0));
  }
};

Cepstra cepstra_of(const Spoken& spoken) {
  std::size_t first = spoken.frames.size(), behind = 0;
  for (std::size_t i = 0; i < spoken.frames.size(); ++i)
    if (spoken.above(spoken.frames[i]) >= kSpeech) {
      first = std::min(first, i);
      behind = i + 1;
    }
  Cepstra result;
  for (std::size_t i = first; i < behind; ++i) {
    auto& cepstra = result.emplace_back();
    for (std::size_t band = 0; band < kBands; ++band) {
      double mean = 0;
      for (std::size_t j = first; j < behind; ++j)
        mean += spoken.audible(spoken.frames[j], band) / static_cast<double>(behind - first);
      const double level = spoken.audible(spoken.frames[i], band) - mean;
      for (std::size_t c = 0; c < cepstra.size(); ++c) {
        const double angle =
            std::numbers::pi * static_cast<double>(c) * (static_cast<double>(band) + 0.5) / kBands;
        cepstra.at(c) += level * (c == 0 ? 8 : 30.3 * std::cos(angle)) / 64;
      }
    }
  }
  return result;
}

own_words_speech speech_of(const Spoken& spoken) {
  own_words_hearer hearer;
  own_words_speech speech;
  std::array<std::uint8_t, kBands> noise;
  std::ranges::copy(spoken.noise, noise.begin());
  const auto count = static_cast<std::uint32_t>(spoken.frames.size());
  own_words_set_noise(&hearer, noise.data(), static_cast<std::uint8_t>(spoken.loudest));
  own_words_begin_speech(&hearer, spoken.is_sample, count);
  const auto each = [&](auto take) {
    while (hearer.at < hearer.end) {
      const own_words_frame frame = packed(spoken.frames.at(hearer.at));
      take(&frame);
    }
  };
  each([&](const own_words_frame* frame) { own_words_survey(&hearer, frame); });
  own_words_end_survey(&hearer, &speech);
  each([&](const own_words_frame* frame) { own_words_transform(&hearer, frame, &speech); });
  return speech;
}

int cepstrum(const own_words_speech& speech, std::size_t frame, std::size_t c) {
  return static_cast<int>(speech.frames[frame][c / 4] >> (c % 4 * 8) & 0xFF) - 128;
}

int drawn(std::mt19937& draw, int from, int to) {
  return std::uniform_int_distribution(from, to)(draw);
}

// A frame with a peak, or one that is soft in all bands; none for which a rounding decides whether it is speech.
Levels random_frame(std::mt19937& draw, const Spoken& spoken, bool soft) {
  while (true) {
    const int peak = drawn(draw, 0, kBands - 1), most = drawn(draw, 0, spoken.loudest - 12);
    Levels frame;
    for (int band = 0; band < kBands; ++band) {
      const int level = soft ? most : spoken.loudest - 3 * std::abs(band - peak);
      const int less = std::clamp(level - drawn(draw, 0, 3), 0, spoken.loudest);
      frame.at(static_cast<std::size_t>(band)) = spoken.is_sample ? spoken.loudest - less : less;
    }
    if (std::abs(spoken.above(frame) - kSpeech) > 2) return frame;
  }
}

Spoken random_speech(std::mt19937& draw, bool is_sample) {
  Spoken spoken;
  spoken.is_sample = is_sample;
  spoken.loudest = drawn(draw, 30, 60);
  for (int& noise : spoken.noise)
    noise = drawn(draw, 2, 20);
  const int begin = drawn(draw, 1, 4), end = drawn(draw, 18, 30);
  for (int i = 0; i < end + 3; ++i)
    spoken.frames.push_back(random_frame(draw, spoken, i < begin || i >= end || i % 9 == 8));
  return spoken;
}

}  // namespace

TEST_CASE("own_words: cepstra are what the formula says, of speech and of samples in its noise") {
  std::mt19937 draw(5);
  for (int round = 0; round < 60; ++round) {
    const Spoken spoken = random_speech(draw, round % 2 == 0);
    const Cepstra wanted = cepstra_of(spoken);
    const own_words_speech speech = speech_of(spoken);
    REQUIRE(speech.count == wanted.size());
    REQUIRE(speech.count > 10);
    int lively = 0;
    for (std::size_t i = 0; i < wanted.size(); ++i)
      for (std::size_t c = 0; c < OWN_WORDS_CEPSTRA; ++c) {
        const int found = cepstrum(speech, i, c);
        lively += std::abs(found);
        INFO(round << ": cepstrum " << c << " of frame " << i << " of " << wanted.size());
        CHECK(found == Approx(std::clamp(wanted[i].at(c), -128.0, 127.0)).margin(1.5));
      }
    CHECK(speech.liveliness == static_cast<std::uint32_t>(lively));
  }
}

TEST_CASE("own_words: in what nobody can hear there is no speech") {
  Spoken quiet;
  quiet.frames.resize(20, Levels{});
  quiet.noise.fill(10);
  quiet.loudest = 12;
  CHECK(speech_of(quiet).count == 0);
}

namespace {

// ---- warping

own_words_speech random_cepstra(std::mt19937& draw, std::uint32_t count) {
  own_words_speech speech{};
  speech.count = count;
  auto four = static_cast<std::uint32_t>(draw());
  for (std::uint32_t i = 0; i < count; ++i)
    for (std::uint32_t& value : speech.frames[i]) {
      if (draw() % 3 == 0) four = static_cast<std::uint32_t>(draw());
      value = four;
    }
  speech.liveliness = draw() % 3 == 0 ? 0 : 1000 * count;
  return speech;
}

std::uint64_t apart(const own_words_speech& a, std::size_t i, const own_words_speech& b,
                    std::size_t j) {
  int sum = 0;
  for (std::size_t c = 0; c < OWN_WORDS_CEPSTRA; ++c)
    sum += std::abs(cepstrum(a, i, c) - cepstrum(b, j, c));
  return static_cast<std::uint64_t>(sum);
}

constexpr std::uint64_t kNoWay = 1'000'000'000;

// Sakoe and Chiba, table I, the symmetric form with P = 1: a step is (1, 1), or it is followed by one along an axis.
std::uint64_t least_cost(const own_words_speech& a, const own_words_speech& b) {
  std::vector<std::vector<std::uint64_t>> cost(a.count, std::vector(b.count, kNoWay));
  const auto at = [&](std::size_t i, std::size_t j, std::size_t back_i, std::size_t back_j) {
    return i < back_i || j < back_j ? kNoWay : cost[i - back_i][j - back_j];
  };
  for (std::size_t i = 0; i < a.count; ++i)
    for (std::size_t j = 0; j < b.count; ++j) {
      const std::uint64_t here = apart(a, i, b, j);
      std::uint64_t least = i == 0 && j == 0 ? 0 : kNoWay;
      least = std::min(least, at(i, j, 1, 1));
      std::uint64_t all = least + 2 * here;
      if (j > 1) all = std::min(all, at(i, j, 1, 2) + 2 * apart(a, i, b, j - 1) + here);
      if (i > 1) all = std::min(all, at(i, j, 2, 1) + 2 * apart(a, i - 1, b, j) + here);
      cost[i][j] = std::min(all, kNoWay);
    }
  return cost[a.count - 1][b.count - 1];
}

// The distance, or nothing: there is no path below the limit.
std::pair<bool, std::uint32_t> warped(const own_words_speech& a, const own_words_speech& b,
                                      std::uint32_t limit) {
  own_words_warp warp;
  own_words_begin_warp(&warp, limit);
  while (warp.at < a.count)
    if (own_words_warp_row(&warp, &a, &b) == 0) return {false, 0};
  return {true, own_words_warped(&warp, &a, &b)};
}

}  // namespace

TEST_CASE(
    "own_words: the distance is that of the best path, and what has none below the limit ends") {
  std::mt19937 draw(7);
  unsigned ways = 0, ended = 0;
  for (int round = 0; round < 300; ++round) {
    const auto count = [&] {
      return static_cast<std::uint32_t>(drawn(draw, 1, round < 20 ? 92 : 20));
    };
    const own_words_speech a = random_cepstra(draw, count()), b = random_cepstra(draw, count());
    const std::uint64_t least = least_cost(a, b);
    CHECK((own_words_can_align(a.count, b.count) != 0) ==
          (a.count <= 2 * b.count && b.count <= 2 * a.count));
    if (own_words_can_align(a.count, b.count) == 0) continue;
    INFO(round << ": " << a.count << " and " << b.count << " frames");
    const std::uint64_t all = a.liveliness + b.liveliness + 1;
    const auto wanted = static_cast<std::uint32_t>(
        least >= kNoWay ? std::uint64_t{OWN_WORDS_APART}
                        : std::min<std::uint64_t>(least * 1000 / all, OWN_WORDS_APART));
    CHECK(warped(a, b, UINT32_MAX) == std::pair(true, wanted));
    if (least >= kNoWay) continue;
    ++ways;
    CHECK(warped(a, b, static_cast<std::uint32_t>(least)) == std::pair(true, wanted));
    if (!warped(a, b, static_cast<std::uint32_t>(least / 3)).first) ++ended;
    CHECK(own_words_cost_of(wanted + 1, &a, &b) > least);
  }
  CHECK(ways > 100);
  CHECK(ended > ways / 2);
  CHECK(own_words_can_align(0, 0) == 0);
}

}  // namespace own_words_parts
