// How far something may be from a word that rsc teach was given, and which words it reports as alike (docs/algorithms.md#own_words).
// The words are synthetic: a peak that moves.
#include "companion/distances.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <catch2/catch.hpp>

// Other tests of one program use these names, too.
namespace distances {

using namespace robosync::companion;

namespace {

// Its peak moves from one band to the other and has this width.
Sample sample_of(double from, double to, std::size_t frames, double width = 1) {
  Sample sample(frames, own_words_frame{});
  for (std::size_t i = 0; i < frames; ++i)
    for (unsigned band = 0; band < OWN_WORDS_BANDS; ++band) {
      const double part = static_cast<double>(i) / static_cast<double>(frames - 1);
      const double off = std::abs(band - (from + (to - from) * part)) / width;
      const auto below = static_cast<std::uint32_t>(std::clamp(off * off * 2, 0.0, 40.0));
      sample[i].values[band / 5] |= below << (band % 5 * 6);
    }
  return sample;
}

TaughtWord word(double from, double to, double spread = 0) {
  return {"word",
          {sample_of(from, to, 30), sample_of(from + spread, to, 33, 1 + spread / 8),
           sample_of(from, to + spread, 36, 1 + spread / 6)}};
}

Distance nearest_in(const Sample& sample, const TaughtWord& word) {
  Distance nearest = kApart;
  for (const Sample& other : word.samples)
    if (&other != &sample) nearest = std::min(nearest, distance_between(sample, other));
  return nearest;
}

}  // namespace

TEST_CASE(
    "a word's distances: 4 times its own, from 33 to 55 %, and 65 % of the nearest other word") {
  const std::vector<TaughtWord> words{word(2, 12), word(16, 3), word(2, 12.5, 1), word(8, 9, 3)};
  const std::vector<Allowed> allowed = allowed_distances(words);
  REQUIRE(allowed.size() == words.size());
  std::array<bool, 3> limits{};
  for (std::size_t i = 0; i < words.size(); ++i) {
    Distance own = 0, nearest = kApart;
    std::size_t other = 0;
    for (const Sample& sample : words[i].samples) {
      own += nearest_in(sample, words[i]);
      for (std::size_t j = 0; j < words.size(); ++j)
        if (j != i && nearest_in(sample, words[j]) < nearest) {
          nearest = nearest_in(sample, words[j]);
          other = j;
        }
    }
    own /= 3;
    INFO(i << ": own " << own << ", nearest " << nearest);
    CHECK(allowed[i].own == own);
    CHECK(allowed[i].nearest == nearest);
    CHECK(allowed[i].other == other);
    const Distance most = std::min(std::max(4 * own, Distance{330}), Distance{550});
    CHECK(allowed[i].most == std::min(most, 65 * nearest / 100));
    limits[0] |= most == 330 && most < 65 * nearest / 100;
    limits[1] |= most == 550 && most < 65 * nearest / 100;
    limits[2] |= most > 65 * nearest / 100;
  }
  CHECK(limits == std::array{true, true, true});
}

TEST_CASE("a word alone has its own limit only") {
  const std::vector<Allowed> allowed = allowed_distances({word(2, 12)});
  CHECK(allowed[0].nearest == kApart);
  CHECK(allowed[0].most == 330);
  CHECK(allowed_distances({}).empty());
}

TEST_CASE("the more the samples of a word differ, the more may something differ from it") {
  std::size_t between = 0;
  for (int spread = 0; spread <= 40; ++spread) {
    const Allowed allowed = allowed_distances({word(2, 12, spread / 10.0)}).front();
    INFO(spread << ": own " << allowed.own);
    CHECK(allowed.most == std::clamp(4 * allowed.own, Distance{330}, Distance{550}));
    between += allowed.most > 330 && allowed.most < 550;
  }
  CHECK(between > 0);
}

TEST_CASE(
    "words sound alike that are less than 45 % apart, or than twice what a word's own samples "
    "are") {
  CHECK(sound_alike({.own = 50, .nearest = 449}));
  CHECK_FALSE(sound_alike({.own = 50, .nearest = 450}));
  CHECK(sound_alike({.own = 300, .nearest = 599}));
  CHECK_FALSE(sound_alike({.own = 300, .nearest = 600}));
}

}  // namespace distances
