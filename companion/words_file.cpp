// See words_file.hpp.
#include "companion/words_file.hpp"

#include <algorithm>
#include <charconv>
#include <iterator>
#include <optional>

namespace robosync::companion {
namespace {

constexpr std::string_view kFirstLine = "robosync words 2";
constexpr std::string_view kOldFirstLine = "robosync words 1";
constexpr std::string_view kHex = "0123456789abcdef";
// A level is a character: these and the next 63.
constexpr char kNoLevel = '0', kMostLevel = kNoLevel + OWN_WORDS_MOST_LEVEL;
constexpr unsigned kLevelBits = 6;
constexpr std::size_t kBands = OWN_WORDS_BANDS, kInValue = kBands / OWN_WORDS_VALUES;
constexpr std::string_view kSum = "sum ";
constexpr std::size_t kSumDigits = 8, kSumLine = kSum.size() + kSumDigits + 1;

bool is_letter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
}

char lower(char c) {
  return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}

// CRC-32 (IEEE 802.3), bit by bit: a file is a few kilobytes.
std::uint32_t sum_of(std::string_view text) {
  std::uint32_t sum = 0xFFFFFFFFU;
  for (const char c : text) {
    sum ^= static_cast<std::uint8_t>(c);
    for (int bit = 0; bit < 8; ++bit)
      sum = (sum >> 1U) ^ (0xEDB88320U & (0U - (sum & 1U)));
  }
  return ~sum;
}

// The line after `key` and a space.
std::optional<std::string_view> after(std::string_view line, std::string_view key) {
  if (!line.starts_with(key) || line.size() <= key.size() || line[key.size()] != ' ')
    return std::nullopt;
  return line.substr(key.size() + 1);
}

unsigned level_of(const own_words_frame& frame, std::size_t band) {
  return frame.values[band / kInValue] >> (band % kInValue * kLevelBits) & OWN_WORDS_MOST_LEVEL;
}

class Reader {
public:
  explicit Reader(std::string_view text) : rest_(text) {}

  ReadWords read() {
    read_head();
    while (trouble_.empty() && !rest_.empty())
      read_line();
    check_last();
    if (trouble_.empty()) return {std::move(words_), {}, 0};
    return {{}, trouble_, line_};
  }

private:
  void fail(const std::string& why) {
    if (trouble_.empty()) trouble_ = why;
  }

  // The next line, without its line end.
  std::string_view next() {
    const std::size_t end = std::min(rest_.find('\n'), rest_.size());
    const std::string_view line = rest_.substr(0, end);
    rest_.remove_prefix(std::min(end + 1, rest_.size()));
    ++line_;
    return line;
  }

  // The checksum is checked first: if the file is damaged, no other error is worth reporting.
  void read_head() {
    const std::string_view text = rest_;
    const std::string_view first = next();
    if (text.size() > kLargestFile) return fail("it is larger than any file of words");
    if (!first.starts_with(kFirstLineOfAny))
      return fail("it is no file of words: its first line is not `" + std::string(kFirstLine) +
                  "`");
    if (first == kOldFirstLine)
      return fail("its words were taught to an earlier version of RoboSync: teach them again");
    if (first != kFirstLine) return fail("it was made by another version of RoboSync");
    const std::size_t length = text.size() - std::min(text.size(), kSumLine);
    if (with_sum(std::string(text.substr(0, length))) != text)
      return fail("it is broken or cut off: its last line is not the sum of the others");
    rest_ = rest_.substr(0, length - first.size() - 1);
  }

  void read_line() {
    const std::string_view line = next();
    if (const auto name = after(line, "word"))
      add_word(*name);
    else if (const auto frames = after(line, "sample"))
      add_sample(*frames);
    else
      fail("a line begins with `word` or `sample` here");
  }

  // NAME DISTANCE
  void add_word(std::string_view text) {
    check_last();
    const std::size_t space = std::min(text.find(' '), text.size());
    const std::string_view name = text.substr(0, space),
                           most = text.substr(std::min(space + 1, text.size()));
    std::uint32_t distance = 0;
    const auto read = std::from_chars(most.data(), most.data() + most.size(), distance);
    if (read.ec != std::errc{} || read.ptr != most.data() + most.size() ||
        distance > OWN_WORDS_MOST_DISTANCE)
      return fail("after a word stands its distance, 0 to " +
                  std::to_string(OWN_WORDS_MOST_DISTANCE));
    if (!can_be_word(name)) return fail("this cannot be the name of a word");
    if (words_.size() == kMostWords) return fail("there are more words than there is room for");
    for (const TaughtWord& word : words_)
      if (same_word(word.name, name)) return fail("this word stands here twice");
    words_.push_back({std::string(name), {}, distance});
  }

  void add_sample(std::string_view count) {
    std::size_t frames = 0;
    const char* const end = count.data() + count.size();
    const auto read = std::from_chars(count.data(), end, frames);
    if (words_.empty()) return fail("a sample belongs to a word");
    if (read.ec != std::errc{} || read.ptr != end || frames < kLeastFrames || frames > kMostFrames)
      return fail("a sample has from " + std::to_string(kLeastFrames) + " to " +
                  std::to_string(kMostFrames) + " lines");
    if (words_.back().samples.size() == kMostSamples)
      return fail("a word has " + std::to_string(kMostSamples) + " samples at most");
    Sample& sample = words_.back().samples.emplace_back(frames, own_words_frame{});
    for (std::size_t i = 0; i < frames && trouble_.empty(); ++i)
      read_frame(sample[i]);
  }

  void read_frame(own_words_frame& frame) {
    const std::string_view line = next();
    const auto is_level = [](char c) { return c >= kNoLevel && c <= kMostLevel; };
    if (line.size() != kBands || !std::ranges::all_of(line, is_level))
      return fail("a line of a sample has " + std::to_string(kBands) + " characters, 0 to o");
    for (std::size_t band = 0; band < kBands; ++band)
      frame.values[band / kInValue] |= static_cast<std::uint32_t>(line[band] - kNoLevel)
                                       << (band % kInValue * kLevelBits);
  }

  void check_last() {
    if (!words_.empty() && words_.back().samples.empty()) fail("the word before has no sample");
  }

  std::string_view rest_;
  std::size_t line_ = 0;
  std::vector<TaughtWord> words_;
  std::string trouble_;
};

}  // namespace

ReadWords read_words(std::string_view text) {
  return Reader(text).read();
}

std::string write_words(const std::vector<TaughtWord>& words) {
  std::string text = std::string(kFirstLine) + "\n";
  for (const TaughtWord& word : words) {
    text += "word " + word.name + " " + std::to_string(word.most) + "\n";
    for (const Sample& sample : word.samples) {
      text += "sample " + std::to_string(sample.size()) + "\n";
      for (const own_words_frame& frame : sample) {
        for (std::size_t band = 0; band < kBands; ++band)
          text += static_cast<char>(kNoLevel + level_of(frame, band));
        text += '\n';
      }
    }
  }
  return with_sum(std::move(text));
}

std::vector<std::int32_t> constants_of(const std::vector<TaughtWord>& words) {
  std::vector<std::int32_t> constants;
  for (const TaughtWord& word : words)
    for (const Sample& sample : word.samples) {
      constants.push_back(own_words_header(static_cast<std::uint32_t>(&word - words.data()),
                                           static_cast<std::uint32_t>(sample.size()), word.most));
      for (const own_words_frame& frame : sample)
        constants.insert(constants.end(), std::begin(frame.values), std::end(frame.values));
    }
  return constants;
}

std::string with_sum(std::string text) {
  std::string digits(kSumDigits, '0');
  std::uint32_t rest = sum_of(text);
  for (std::size_t i = kSumDigits; i-- > 0; rest >>= 4U)
    digits[i] = kHex[rest & 15U];
  text += kSum;
  text += digits;
  text += '\n';
  return text;
}

bool can_be_word(std::string_view name) {
  if (name.empty() || name.size() > kLongestName || !is_letter(name.front())) return false;
  if (same_word(name, kNoWord) || same_word(name, "unknown")) return false;
  return std::ranges::all_of(name, [](char c) { return is_letter(c) || (c >= '0' && c <= '9'); });
}

bool same_word(std::string_view a, std::string_view b) {
  return std::ranges::equal(a, b, {}, lower, lower);
}

}  // namespace robosync::companion
