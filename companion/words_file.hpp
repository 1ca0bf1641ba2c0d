// The file format of taught words (`rsc teach`; docs/algorithms.md#the-file-of-words). The file does not contain their sound, but
// the loudness of each frequency band in each 16 ms of a sample. This uses only the standard library, so that rsc can use it,
// too: it needs the names.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace robosync::companion {

constexpr std::size_t kBands = 20;
// In half decibels: in a sample, below its loudest band, at most 255; in an utterance, above the softest.
using Levels = std::array<std::uint8_t, kBands>;
using Sample = std::vector<Levels>;

constexpr std::size_t kMostWords = 24, kMostSamples = 8;    // samples of each word
constexpr std::size_t kLeastFrames = 8, kMostFrames = 125;  // of a sample: 128 ms to 2 s
constexpr std::size_t kLongestName = 31;
constexpr std::size_t kLargestFile = 1 << 20;
constexpr std::string_view kNoWord = "none";  // the value when none of them was heard

struct TaughtWord {
  std::string name;
  std::vector<Sample> samples;
};

struct ReadWords {
  std::vector<TaughtWord> words;
  std::string trouble;   // the error; empty: none. With an error there are no words
  std::size_t line = 0;  // the error's line
};

// Never throws, whatever `text` is.
[[nodiscard]] ReadWords read_words(std::string_view text);
[[nodiscard]] std::string write_words(const std::vector<TaughtWord>& words);
// Appends the last line, the checksum, which tells an intact file from a damaged one.
[[nodiscard]] std::string with_sum(std::string text);

// A letter or _, then letters, digits or _, all ASCII; and not a name with another meaning.
[[nodiscard]] bool can_be_word(std::string_view name);
// Compares words as programs do: ignoring case.
[[nodiscard]] bool same_word(std::string_view a, std::string_view b);

}  // namespace robosync::companion
