// How far a word's samples are from each other and from those of other words, and how far from them something may be that is still
// taken for the word.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "companion/words_file.hpp"

namespace robosync::companion {

// In thousandths of the distance of sounds that have nothing in common. kApart if they cannot be aligned.
using Distance = std::uint32_t;
constexpr Distance kApart = OWN_WORDS_APART;

// In a quiet room.
[[nodiscard]] Distance distance_between(const Sample& a, const Sample& b);

struct Allowed {
  Distance own = 0;           // mean distance from each sample to the nearest other one of the word
  Distance nearest = kApart;  // to a sample of another word
  std::size_t other = 0;      // the index of that word
  Distance most = 0;          // what is further away is not the word
};
[[nodiscard]] std::vector<Allowed> allowed_distances(const std::vector<TaughtWord>& words);
// Whether a word and the one nearest to it may be mistaken for each other.
[[nodiscard]] bool sound_alike(const Allowed& allowed);

}  // namespace robosync::companion
