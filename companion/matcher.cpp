// See matcher.hpp.
#include "companion/matcher.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <utility>

namespace robosync::companion {
namespace {

constexpr double kParts = 16;             // cepstra count in this fraction of a decibel
constexpr double kHalf = 2;               // levels are half decibels
constexpr double kLoudnessCounts = 0.15;  // a frame's loudness says less than its spectrum
constexpr int kNoiseVaries = 3;           // the noise was measured where it was softest
constexpr int kLoud = 5;  // above the noise, mean of all bands: where speech begins and ends
// Chosen with the recordings of `scripts/rates --settings`.
constexpr double kTimesOwn = 4, kLeast = 330, kMost = 550;  // largest distance from a word
constexpr double kOfNearest = 0.65;  // … as a fraction of that of another word's nearest sample
constexpr Distance kAlike = 450, kTimesOwnAlike = 2;
constexpr int kLoudest = 160;  // of a sample in a quiet room
constexpr int kDeepest = 90;   // half decibels below the loudest: inaudible

// c0 of the levels is their mean; the others are how much they rise and fall once, twice … over the bands.
std::array<std::array<double, kBands>, kCepstra> waves() {
  std::array<std::array<double, kBands>, kCepstra> result{};
  for (std::size_t i = 0; i < kCepstra; ++i)
    for (std::size_t band = 0; band < kBands; ++band)
      result[i][band] = std::cos(std::numbers::pi * static_cast<double>(i) *
                                 (static_cast<double>(band) + 0.5) / kBands) *
                        std::sqrt((i == 0 ? kLoudnessCounts : 2.0) / kBands);
  return result;
}

// The level of two sounds together, in half decibels.
double together(double a, double b) {
  return 20 * std::log10(std::pow(10, a / 20) + std::pow(10, b / 20));
}

Distance apart(const Cepstrum& a, const Cepstrum& b) {
  std::int64_t squares = 0;
  for (std::size_t i = 0; i < kCepstra; ++i) {
    const std::int64_t difference = a[i] - b[i];
    squares += difference * difference;
  }
  return static_cast<Distance>(std::sqrt(static_cast<double>(squares)) * (100 / kParts));
}

// The sum of its frames' distances from their mean.
std::uint64_t liveliness(std::span<const Cepstrum> frames) {
  std::uint64_t sum = 0;
  for (const Cepstrum& frame : frames)
    sum += apart(frame, {});
  return sum;
}

// The columns of row `i` that a path with these slopes from corner to corner can pass, plus two on either side, so that the
// places reached from there have been computed, too.
std::pair<std::size_t, std::size_t> reach(std::size_t i, std::size_t rows, std::size_t columns) {
  constexpr std::size_t kBeside = 2;
  const std::size_t behind = rows - 1 - i, last = columns - 1;
  const std::size_t first = std::max(i / 2, last - std::min(last, 2 * behind));
  const std::size_t end = std::min(2 * i, last - std::min(last, behind / 2));
  return {first - std::min(first, kBeside), std::min(end + kBeside, last) + 1};
}

// A sample, in a quiet room.
struct Known {
  std::size_t word;
  Cepstra cepstra;
  Distance nearest = kApart;  // to the other samples of its word
};

std::vector<Known> all_known(const std::vector<TaughtWord>& words) {
  std::vector<Known> known;
  for (std::size_t word = 0; word < words.size(); ++word)
    for (const Sample& sample : words[word].samples)
      known.emplace_back(Known{word, {}, kApart}).cepstra.of_sample(sample, kLoudest, {});
  return known;
}

void take_nearest(Distance distance, std::size_t other, Allowed& into) {
  if (distance >= into.nearest) return;
  into.nearest = distance;
  into.other = other;
}

void compare_all(std::vector<Known>& known, std::vector<Allowed>& allowed) {
  Warping warping;
  for (std::size_t i = 0; i < known.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      Known &one = known[i], &other = known[j];
      const Distance distance = warping.between(one.cepstra.frames(), other.cepstra.frames());
      if (one.word == other.word) {
        one.nearest = std::min(one.nearest, distance);
        other.nearest = std::min(other.nearest, distance);
      } else {
        take_nearest(distance, other.word, allowed[one.word]);
        take_nearest(distance, one.word, allowed[other.word]);
      }
    }
}

}  // namespace

void Cepstra::of_sample(const Sample& sample, int loudest, const Levels& noise) {
  begin(noise, loudest - kDeepest);
  std::array<double, kBands> levels;
  for (const Levels& frame : sample) {
    for (std::size_t band = 0; band < kBands; ++band)
      levels[band] = together(loudest - frame[band], floor_[band]);
    add(levels);
  }
  end();
}

void Cepstra::of_heard(const Sample& heard, const Levels& noise) {
  begin(noise, loudest_of(heard) - kDeepest);
  std::array<double, kBands> levels;
  for (const Levels& frame : heard) {
    for (std::size_t band = 0; band < kBands; ++band)
      levels[band] = std::max(static_cast<double>(frame[band]), floor_[band]);
    add(levels);
  }
  end();
}

void Cepstra::begin(const Levels& noise, int deepest) {
  for (std::size_t band = 0; band < kBands; ++band)
    floor_[band] = std::max(noise[band] + kNoiseVaries, deepest);
  count_ = until_ = 0;
}

// Leaves out frames that do not rise above the noise at the beginning and the end.
void Cepstra::add(const std::array<double, kBands>& levels) {
  static const auto kWaves = waves();
  double above = 0;
  for (std::size_t band = 0; band < kBands; ++band)
    above += std::max(levels[band] - floor_[band], 0.0);
  const bool loud = above >= kLoud * static_cast<double>(kBands);
  if (count_ == frames_.size() || (!loud && count_ == 0)) return;
  Cepstrum& cepstrum = frames_[count_++];
  if (loud) until_ = count_;
  for (std::size_t i = 0; i < kCepstra; ++i) {
    double sum = 0;
    for (std::size_t band = 0; band < kBands; ++band)
      sum += levels[band] * kWaves[i][band];
    cepstrum[i] = static_cast<std::int16_t>(std::lround(sum * (kParts / kHalf)));
  }
}

// Subtracts the mean: the part common to all frames comes from the microphone and the speaker's distance.
void Cepstra::end() {
  count_ = until_;
  for (std::size_t i = 0; i < kCepstra && count_ != 0; ++i) {
    std::int32_t sum = 0;
    for (const Cepstrum& cepstrum : frames())
      sum += cepstrum[i];
    const std::int32_t mean = sum / static_cast<std::int32_t>(count_);
    for (std::size_t frame = 0; frame < count_; ++frame)
      frames_[frame][i] = static_cast<std::int16_t>(frames_[frame][i] - mean);
  }
}

// Rows are frames of `a`, and begin with two unreachable places.
Distance Warping::between(std::span<const Cepstrum> a, std::span<const Cepstrum> b) {
  if (a.empty() || b.empty() || a.size() > 2 * b.size() || b.size() > 2 * a.size()) return kApart;
  constexpr Distance kNever = UINT32_MAX / 4;
  for (Row& row : costs_)
    row.fill(kNever);
  local_[1].fill(kNever);
  for (std::size_t i = 0; i < a.size(); ++i) {
    Row& now = costs_[i % 3];
    const Row &before = costs_[(i + 2) % 3], &twice_before = costs_[(i + 1) % 3];
    Row& here = local_[i % 2];
    const Row& there = local_[(i + 1) % 2];
    now.fill(kNever);
    here.fill(kNever);
    const auto [first, end] = reach(i, a.size(), b.size());
    for (std::size_t j = first; j < end; ++j) {
      const std::size_t at = j + 2;
      here[at] = apart(a[i], b[j]);
      const Distance straight = (i == 0 && j == 0) ? 0 : before[at - 1];
      const Distance wide = before[at - 2] + 2 * here[at - 1];
      const Distance steep = twice_before[at - 1] + 2 * there[at];
      now[at] = std::min({straight + 2 * here[at], wide < kNever ? wide + here[at] : kNever,
                          steep < kNever ? steep + here[at] : kNever, kNever});
    }
  }
  const Distance cost = costs_[(a.size() - 1) % 3][b.size() + 1];
  if (cost >= kNever) return kApart;
  const std::uint64_t zero = liveliness(a) + liveliness(b) + 1;
  return static_cast<Distance>(std::min<std::uint64_t>(std::uint64_t{cost} * 1000 / zero, kApart));
}

int loudest_of(const Sample& sample) {
  std::uint8_t loudest = 0;
  for (const Levels& frame : sample)
    loudest = std::max(loudest, *std::ranges::max_element(frame));
  return loudest;
}

Sample below_loudest(const Utterance& utterance) {
  Sample result = utterance.levels;
  const int loudest = loudest_of(result);
  for (Levels& frame : result)
    for (std::uint8_t& level : frame)
      level = static_cast<std::uint8_t>(loudest - level);
  return result;
}

Distance distance_between(const Sample& a, const Sample& b) {
  Cepstra one, other;
  Warping warping;
  one.of_sample(a, kLoudest, {});
  other.of_sample(b, kLoudest, {});
  return warping.between(one.frames(), other.frames());
}

std::vector<Allowed> allowed_distances(const std::vector<TaughtWord>& words, double strict) {
  std::vector<Allowed> allowed(words.size());
  std::vector<Known> known = all_known(words);
  compare_all(known, allowed);
  for (std::size_t word = 0; word < words.size(); ++word) {
    std::uint64_t sum = 0;
    for (const Known& one : known)
      if (one.word == word) sum += one.nearest;
    Allowed& one = allowed[word];
    one.own = static_cast<Distance>(sum / std::max<std::size_t>(words[word].samples.size(), 1));
    const double own = std::clamp(kTimesOwn * one.own, kLeast, kMost);
    const double most = std::min(own, kOfNearest * one.nearest) * (kUsualStrict / strict);
    one.most = static_cast<Distance>(most);
  }
  return allowed;
}

bool sound_alike(const Allowed& allowed) {
  return allowed.nearest < kAlike || allowed.nearest < kTimesOwnAlike * allowed.own;
}

Matcher::Matcher(const std::vector<TaughtWord>& words, double strict)
    : words_(words), allowed_(allowed_distances(words, strict)) {}

Distance Matcher::nearest(const TaughtWord& word, int loudest, const Levels& noise) {
  Distance nearest = kApart;
  for (const Sample& sample : word.samples) {
    sample_.of_sample(sample, loudest, noise);
    nearest = std::min(nearest, warping_.between(heard_.frames(), sample_.frames()));
  }
  return nearest;
}

std::optional<std::size_t> Matcher::match(const Utterance& utterance) {
  heard_.of_heard(utterance.levels, utterance.noise);
  const int loudest = loudest_of(utterance.levels);
  Distance best = kApart;
  std::size_t which = 0;
  for (std::size_t word = 0; word < words_.size(); ++word) {
    const Distance distance = nearest(words_[word], loudest, utterance.noise);
    if (distance >= best) continue;
    best = distance;
    which = word;
  }
  if (words_.empty() || best > allowed_[which].most) return std::nullopt;
  return which;
}

}  // namespace robosync::companion
