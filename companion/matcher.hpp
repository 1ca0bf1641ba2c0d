// Which of the taught words something is that was said, if any. Both become cepstra (S. Davis and P. Mermelstein, IEEE Trans. ASSP
// 28 (1980), section II), and are laid over each other so that they fit best (dynamic time warping: H. Sakoe and S. Chiba,
// "Dynamic programming algorithm optimization for spoken word recognition", IEEE Trans. ASSP 26 (1978), the symmetric form with slopes
// from 1/2 to 2). Samples were taken in a quiet room: the noise of the moment is added to them first.
//
// How far something may be from a word follows from how far the word's samples are from each other, and from those of other words.
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

// How far two samples are apart, in thousandths of how far their frames are from their own means: noise that covers a part of what
// is said makes everything more alike, and so counts on both sides. Where they cannot be laid over each other it is kApart.
using Distance = std::uint32_t;
constexpr Distance kApart = 1'000'000;

constexpr std::size_t kCepstra = 13;
using Cepstrum = std::array<std::int16_t, kCepstra>;

// What is said in a sample. Room for the longest one: nothing is allocated.
class Cepstra {
public:
  // Of a file: what it would be in this noise if its loudest band were `loudest`.
  void of_sample(const Sample& sample, int loudest, const Levels& noise);
  // Of an utterance: nothing counts as softer than the noise.
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

// How far a sample's loudest band is above the softest level.
[[nodiscard]] int loudest_of(const Sample& sample);
// As it stands in a file: how far below the loudest.
[[nodiscard]] Sample below_loudest(const Utterance& utterance);

// Between samples of a file, in a quiet room.
[[nodiscard]] Distance distance_between(const Sample& a, const Sample& b);

struct Allowed {
  Distance own = 0;           // from each sample to the nearest other one of the word, in the mean
  Distance nearest = kApart;  // to a sample of another word
  std::size_t other = 0;      // the place of that word
  Distance most = 0;          // what is further away is not the word
};
// What `strict` is when robot.json does not say (modules.def).
constexpr double kUsualStrict = 50;
// Of each word. The higher `strict`, the less is taken for a word.
[[nodiscard]] std::vector<Allowed> allowed_distances(const std::vector<TaughtWord>& words,
                                                     double strict);
// A word and the one that is nearest to it: one of them may be taken for the other.
[[nodiscard]] bool sound_alike(const Allowed& allowed);

class Matcher {
public:
  Matcher(const std::vector<TaughtWord>& words, double strict);
  // The place of the word, or nothing.
  [[nodiscard]] std::optional<std::size_t> match(const Utterance& utterance);

private:
  [[nodiscard]] Distance nearest(const TaughtWord& word, int loudest, const Levels& noise);

  const std::vector<TaughtWord>& words_;
  std::vector<Allowed> allowed_;
  Cepstra heard_, sample_;
  Warping warping_;
};

}  // namespace robosync::companion
