// See distances.hpp.
#include "companion/distances.hpp"

#include <algorithm>

#include "runtime-m4/algorithms/own_words_distance.h"

namespace robosync::companion {
namespace {

// Chosen with the recordings of `scripts/rates --settings`. The largest distance from a word, …
constexpr Distance kTimesOwn = 4, kLeast = 330, kMost = OWN_WORDS_MOST_DISTANCE;
constexpr Distance kOfNearest = 65;  // … as a percentage of that of another word's nearest sample
constexpr Distance kAlike = 450, kTimesOwnAlike = 2;

struct Known {
  std::size_t word;
  const Sample* sample;
  Distance nearest = kApart;  // to the other samples of its word
};

void take_nearest(Distance distance, std::size_t other, Allowed& into) {
  if (distance >= into.nearest) return;
  into.nearest = distance;
  into.other = other;
}

void compare(Known& one, Known& other, std::vector<Allowed>& allowed) {
  const Distance distance = distance_between(*one.sample, *other.sample);
  if (one.word == other.word) {
    one.nearest = std::min(one.nearest, distance);
    other.nearest = std::min(other.nearest, distance);
  } else {
    take_nearest(distance, other.word, allowed[one.word]);
    take_nearest(distance, one.word, allowed[other.word]);
  }
}

}  // namespace

Distance distance_between(const Sample& a, const Sample& b) {
  return own_words_distance(a.data(), static_cast<std::uint32_t>(a.size()), b.data(),
                            static_cast<std::uint32_t>(b.size()));
}

std::vector<Allowed> allowed_distances(const std::vector<TaughtWord>& words) {
  std::vector<Allowed> allowed(words.size());
  std::vector<Known> known;
  for (std::size_t word = 0; word < words.size(); ++word)
    for (const Sample& sample : words[word].samples) {
      known.push_back({word, &sample});
      for (std::size_t i = 0; i + 1 < known.size(); ++i)
        compare(known.back(), known[i], allowed);
    }
  for (std::size_t word = 0; word < words.size(); ++word) {
    std::uint64_t sum = 0;
    for (const Known& one : known)
      if (one.word == word) sum += one.nearest;
    Allowed& one = allowed[word];
    one.own = static_cast<Distance>(sum / std::max<std::size_t>(words[word].samples.size(), 1));
    one.most =
        std::min(std::clamp(kTimesOwn * one.own, kLeast, kMost), kOfNearest * one.nearest / 100);
  }
  return allowed;
}

bool sound_alike(const Allowed& allowed) {
  return allowed.nearest < kAlike || allowed.nearest < kTimesOwnAlike * allowed.own;
}

}  // namespace robosync::companion
