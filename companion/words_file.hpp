// Words that somebody has taught (`rsc teach`), as they stand in a file (docs/algorithms.md#the-file-of-words). Their sound is
// not in it: of each 16 ms of a sample, how loud the tones of each band were. Of the standard library alone, so that rsc, too,
// can read it: it wants to know the names.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace robosync::companion {

constexpr std::size_t kBands = 20;
// In halves of a decibel: of a sample how far below its loudest band, 255 at most; of what is heard above the softest.
using Levels = std::array<std::uint8_t, kBands>;
using Sample = std::vector<Levels>;

constexpr std::size_t kMostWords = 24, kMostSamples = 8;    // … of each word
constexpr std::size_t kLeastFrames = 8, kMostFrames = 125;  // of a sample: 128 ms to 2 s
constexpr std::size_t kLongestName = 31;
constexpr std::size_t kLargestFile = 1 << 20;
constexpr std::string_view kNoWord = "none";  // what is said where none of them was heard

struct TaughtWord {
  std::string name;
  std::vector<Sample> samples;
};

struct ReadWords {
  std::vector<TaughtWord> words;
  std::string trouble;   // empty: there is none; else there are no words
  std::size_t line = 0;  // where it is
};

// Never throws, whatever `text` is.
[[nodiscard]] ReadWords read_words(std::string_view text);
[[nodiscard]] std::string write_words(const std::vector<TaughtWord>& words);
// With its last line, which tells a whole file from a broken one.
[[nodiscard]] std::string with_sum(std::string text);

// A letter or _, then letters, digits or _, all of ASCII; and not what means something else.
[[nodiscard]] bool can_be_word(std::string_view name);
// As programs compare words: A is a.
[[nodiscard]] bool same_word(std::string_view a, std::string_view b);

}  // namespace robosync::companion
