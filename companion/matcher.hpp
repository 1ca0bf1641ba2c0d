// Decides which of the taught words an utterance is, if any. Both are converted to cepstra (S. Davis and P. Mermelstein, IEEE
// Trans. ASSP 28 (1980), section II) and aligned for the best fit (dynamic time warping: H. Sakoe and S. Chiba, "Dynamic
// programming algorithm optimization for spoken word recognition", IEEE Trans. ASSP 26 (1978), the symmetric form with slopes
// from 1/2 to 2). Samples were taken in a quiet room, so the present noise is added to them first.
//
// The largest distance at which an utterance still counts as a word follows from the distances of the word's samples to each
// other and to those of other words.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "companion/utterances.hpp"
#include "companion/words_file.hpp"

namespace robosync::companion {

// The distance of two samples, in thousandths of the distance of their frames from their own means: noise that covers part of an
// utterance makes everything more alike, which lowers both. kApart if the samples cannot be aligned.
using Distance = std::uint32_t;
constexpr Distance kApart = 1'000'000;

constexpr std::size_t kCepstra = 13;
using Cepstrum = std::array<std::int16_t, kCepstra>;

// The speech in a sample. It has room for the longest one, so nothing is allocated.
class Cepstra {
public:
  // Of a sample from a file, as it would be in this noise if its loudest band were `loudest`.
  void of_sample(const Sample& sample, int loudest, const Levels& noise);
  // Of an utterance: levels below the noise are raised to it.
  void of_heard(const Sample& heard, const Levels& noise);
  [[nodiscard]] std::span<const Cepstrum> frames() const { return {frames_.data(), count_}; }

private:
  void begin(const Levels& noise, int deepest);
  void add(const std::array<double, kBands>& levels);
  void end();

  std::array<Cepstrum, kMostFrames> frames_{};
  std::array<double, kBands> floor_{};
  std::size_t count_ = 0, until_ = 0;
};

class Warping {
public:
  [[nodiscard]] Distance between(std::span<const Cepstrum> a, std::span<const Cepstrum> b);

private:
  using Row = std::array<Distance, kMostFrames + 2>;
  std::array<Row, 3> costs_{};
  std::array<Row, 2> local_{};
};

// The level of a sample's loudest band above the softest level.
[[nodiscard]] int loudest_of(const Sample& sample);
// In the format of a file: levels below the loudest.
[[nodiscard]] Sample below_loudest(const Utterance& utterance);

// Between samples from a file, in a quiet room.
[[nodiscard]] Distance distance_between(const Sample& a, const Sample& b);

struct Allowed {
  Distance own = 0;           // mean distance from each sample to the nearest other one of the word
  Distance nearest = kApart;  // to a sample of another word
  std::size_t other = 0;      // the index of that word
  Distance most = 0;          // an utterance further away is not the word
};
// The default of `strict` in robot.json (modules.def).
constexpr double kUsualStrict = 50;
// For each word. The higher `strict`, the fewer utterances count as a word.
[[nodiscard]] std::vector<Allowed> allowed_distances(const std::vector<TaughtWord>& words,
                                                     double strict);
// Whether a word and the one nearest to it may be mistaken for each other.
[[nodiscard]] bool sound_alike(const Allowed& allowed);

class Matcher {
public:
  Matcher(const std::vector<TaughtWord>& words, double strict);
  // The index of the word, or nothing.
  [[nodiscard]] std::optional<std::size_t> match(const Utterance& utterance);

private:
  [[nodiscard]] Distance nearest(const TaughtWord& word, int loudest, const Levels& noise);

  const std::vector<TaughtWord>& words_;
  std::vector<Allowed> allowed_;
  Cepstra heard_, sample_;
  Warping warping_;
};

}  // namespace robosync::companion
