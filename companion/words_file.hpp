// The file format of taught words (`rsc teach`; docs/algorithms.md#the-file-of-words), and the constants that the module own_words
// makes of them. The file does not contain their sound, but the loudness of each frequency band in each 20 ms of a sample. This
// uses only the standard library and own_words.h, so that rsc can use it, too.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "runtime-m4/algorithms/own_words.h"

namespace robosync::companion {

// Its levels are below its loudest one.
using Sample = std::vector<own_words_frame>;

constexpr std::size_t kMostWords = 24, kMostSamples = 8;  // samples of each word
// Of a sample: 140 ms to 1.8 s.
constexpr std::size_t kLeastFrames = OWN_WORDS_LEAST_FRAMES, kMostFrames = OWN_WORDS_MOST_FRAMES;
constexpr std::size_t kLongestName = 31;
constexpr std::size_t kLargestFile = 1 << 20;
constexpr std::string_view kFirstLineOfAny = "robosync words ";  // of a file of any version
constexpr std::string_view kNoWord = "none";  // the value when none of them was heard

struct TaughtWord {
  std::string name;
  std::vector<Sample> samples;
  std::uint32_t most =
      0;  // the largest distance at which something is still this word, in thousandths
};

struct ReadWords {
  std::vector<TaughtWord> words;
  std::string trouble;   // the error; empty: none. With an error there are no words
  std::size_t line = 0;  // the error's line
};

// Never throws, whatever `text` is.
[[nodiscard]] ReadWords read_words(std::string_view text);
[[nodiscard]] std::string write_words(const std::vector<TaughtWord>& words);
// What the module gets: the samples of all words, one after the other.
[[nodiscard]] std::vector<std::int32_t> constants_of(const std::vector<TaughtWord>& words);
// Appends the last line, the checksum, which tells an intact file from a damaged one.
[[nodiscard]] std::string with_sum(std::string text);

// A letter or _, then letters, digits or _, all ASCII; and not a name with another meaning.
[[nodiscard]] bool can_be_word(std::string_view name);
// Compares words as programs do: ignoring case.
[[nodiscard]] bool same_word(std::string_view a, std::string_view b);

}  // namespace robosync::companion
