// See teaching.hpp.
#include "companion/teaching.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <span>
#include <system_error>

#include <fcntl.h>
#include <unistd.h>

#include "companion/distances.hpp"
#include "companion/hearing.hpp"
#include "runtime-m4/algorithms/own_words_ear.h"

namespace robosync::companion {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kWanted = 3;  // samples of a word, at least
constexpr Distance kSame = 650;     // two samples further apart are different words
constexpr std::size_t kPerSecond = 1000 / kFrameMs;
constexpr std::size_t kLongestRecording =
    10 * kPerSecond;  // frames; also the longest pause before a word
constexpr unsigned kBitsUsed = drivers::kBandsInValue * drivers::kBandBits;  // of a frame's value
constexpr std::size_t kQuietAfter = 20;  // frames added to a recording that ends with its word

[[noreturn]] void refuse(const std::string& why) {
  throw Failure(Exit::asked_wrongly, why);
}

bool is_file(const std::string& name) {
  std::error_code error;
  return fs::is_regular_file(name, error);
}

// ---- the file

std::vector<TaughtWord> parsed(const std::string& file) {
  std::error_code error;
  const auto size = fs::file_size(file, error);
  std::ifstream in(file, std::ios::binary);
  if (error || !in) throw Failure(Exit::outside, "cannot read " + file);
  if (size > kLargestFile) refuse(file + " is larger than any file of words");
  const std::string text(std::istreambuf_iterator<char>(in), {});
  ReadWords read = read_words(text);
  if (!read.trouble.empty())
    refuse(file + ":" + std::to_string(read.line) + ": " + read.trouble +
           "; put back a copy of it, or delete it and teach its words again");
  return std::move(read.words);
}

// Writes a new file and renames it, so that a reader, even after a power cut, finds either the old file or the new one.
void save(const std::string& file, std::vector<TaughtWord> words) {
  const std::vector<Allowed> allowed = allowed_distances(words);
  for (std::size_t i = 0; i < words.size(); ++i)
    words[i].most = allowed[i].most;
  const std::string text = write_words(words), beside = file + ".new";
  const int out = open(beside.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC | O_NONBLOCK, 0666);
  bool fine = out >= 0;
  for (std::size_t at = 0; fine && at < text.size();) {
    const ssize_t written = write(out, text.data() + at, text.size() - at);
    fine = written > 0;
    at += fine ? static_cast<std::size_t>(written) : 0;
  }
  fine = fine && fsync(out) == 0;
  const int error = errno;
  if (out >= 0) close(out);
  if (fine && std::rename(beside.c_str(), file.c_str()) == 0) return;
  const std::string why = std::strerror(fine ? errno : error);
  unlink(beside.c_str());
  throw Failure(Exit::outside, "cannot write " + file + ": " + why);
}

auto find_word(std::vector<TaughtWord>& words, const std::string& name) {
  return std::ranges::find_if(words,
                              [&](const TaughtWord& word) { return same_word(word.name, name); });
}

// ---- recordings

// What was said last: each level below the loudest.
Sample said(const own_words_ear& ear, std::size_t frames) {
  const std::span<const own_words_frame> all(ear.said, frames);
  std::uint32_t loudest = 0;
  const auto each = [](const own_words_frame& frame, auto take) {
    for (std::size_t value = 0; value < OWN_WORDS_VALUES; ++value)
      for (unsigned shift = 0; shift < kBitsUsed; shift += drivers::kBandBits)
        take(value, shift, frame.values[value] >> shift & OWN_WORDS_MOST_LEVEL);
  };
  for (const own_words_frame& frame : all)
    each(frame,
         [&](std::size_t, unsigned, std::uint32_t level) { loudest = std::max(loudest, level); });
  Sample sample(frames, own_words_frame{});
  for (std::size_t i = 0; i < frames; ++i)
    each(all[i], [&](std::size_t value, unsigned shift, std::uint32_t level) {
      sample[i].values[value] |= (loudest - level) << shift;
    });
  return sample;
}

Sample all_of(Hearing& hearing, const std::string& name) {
  Sample frames;
  for (own_words_frame frame; hearing.next(frame);) {
    if (frames.size() == kLongestRecording)
      refuse(name + " is longer than 10 s: record the word alone, once in each file");
    frames.push_back(frame);
  }
  frames.resize(frames.size() + kQuietAfter);
  return frames;
}

// The single word that is said in a recording.
Sample sample_of(const std::string& recording) {
  if (!is_file(recording)) throw Failure(Exit::outside, "there is no file " + recording);
  Hearing hearing(recording, true);
  const Sample frames = all_of(hearing, recording);
  own_words_ear ear;
  own_words_begin(&ear);
  for (const own_words_frame& frame : frames)
    own_words_learn(&ear, &frame);
  std::vector<Sample> found;
  bool too_long = false;
  for (const own_words_frame& frame : frames) {
    if (const std::uint32_t count = own_words_hear(&ear, &frame); count != 0)
      found.push_back(said(ear, count));
    too_long = too_long || ear.was_too_long != 0;
  }
  if (found.size() == 1) return found.front();
  if (found.size() > 1)
    refuse(recording + ": " + std::to_string(found.size()) +
           " words are heard in it: record the word alone, without a pause in it");
  refuse(recording + (too_long ? ": what is said in it takes more than 1.8 s: a word is shorter"
                               : ": no word is heard in it: it is silent, too noisy or too short"));
}

// Waits until somebody has said the word `count` times.
std::vector<Sample> samples_of_microphone(const std::string& name, const std::string& word,
                                          std::size_t count) {
  Hearing hearing(name, true);
  own_words_ear ear;
  own_words_begin(&ear);
  std::vector<Sample> samples;
  const auto ask = [&] {
    std::printf("say `%s` (%zu of %zu)\n", word.c_str(), samples.size() + 1, count);
    std::fflush(stdout);
  };
  ask();
  std::size_t waited = 0, after = 0;
  for (own_words_frame frame; samples.size() < count;) {
    if (!hearing.next(frame) && ++after == kQuietAfter)
      refuse(name + ": the word is heard " + std::to_string(samples.size()) +
             " times in it, and not " + std::to_string(count) + " times");
    if (++waited == kLongestRecording)
      throw Failure(Exit::outside, "nothing that could be a word was heard for 10 s: is " + name +
                                       " the microphone? (`arecord -L` lists them)");
    const std::uint32_t frames = own_words_hear(&ear, &frame);
    if (frames == 0) continue;
    samples.push_back(said(ear, frames));
    waited = 0;
    if (samples.size() < count) ask();
  }
  return samples;
}

// ---- reports about words

unsigned percent(Distance distance) {
  return std::min((distance + 5) / 10, 100U);
}

void print_word(const TaughtWord& word, const Allowed& allowed,
                const std::vector<TaughtWord>& words) {
  std::printf("%-20s %zu samples, %u %% apart", word.name.c_str(), word.samples.size(),
              percent(allowed.own));
  if (words.size() > 1)
    std::printf(", %u %% from `%s`", percent(allowed.nearest), words[allowed.other].name.c_str());
  std::printf("; is heard up to %u %%\n", percent(allowed.most));
}

void warn(const std::vector<TaughtWord>& words, const std::vector<Allowed>& allowed) {
  for (std::size_t i = 0; i < words.size(); ++i) {
    const std::size_t other = allowed[i].other;
    if (words.size() < 2 || !sound_alike(allowed[i])) continue;
    if (other < i && allowed[other].other == i && sound_alike(allowed[other]))
      continue;  // already reported
    std::printf(
        "warning: `%s` and `%s` sound alike, so both may be missed: take another word for one of "
        "them\n",
        words[i].name.c_str(), words[other].name.c_str());
  }
}

// Refuses a new sample that seems to be another word.
void check_samples(const TaughtWord& word, std::size_t known,
                   const std::vector<std::string>& from) {
  for (std::size_t i = known; i < word.samples.size(); ++i) {
    Distance nearest = kApart;
    for (std::size_t j = 0; j < word.samples.size(); ++j)
      if (j != i) nearest = std::min(nearest, distance_between(word.samples[i], word.samples[j]));
    if (nearest > kSame)
      refuse(from[std::min(i - known, from.size() - 1)] +
             " does not sound like the other samples of `" + word.name +
             "`: say it each time as you will say it to the robot");
  }
}

void check_count(const TaughtWord& word, std::size_t more) {
  const std::size_t count = word.samples.size() + more;
  if (count < kWanted)
    refuse("`" + word.name + "` needs " + std::to_string(kWanted) + " samples: give " +
           std::to_string(kWanted - count) + " more, in which it is said again");
  if (count > kMostSamples)
    refuse("`" + word.name + "` would have " + std::to_string(count) + " samples, and " +
           std::to_string(kMostSamples) + " is the most: --forget it first, to teach it anew");
}

}  // namespace

std::vector<TaughtWord> load_words(const std::string& file) {
  if (!is_file(file))
    throw Failure(Exit::asked_wrongly,
                  "there is no file of words " + file + ": `rsc teach` makes it");
  return parsed(file);
}

void teach(const Arguments& arguments) {
  const std::string& file = arguments.text("words");
  const std::string& name = arguments.text("teach");
  if (!can_be_word(name))
    refuse("`" + name +
           "` cannot be the name of a word: it has up to 31 letters from a to z, digits and _, and "
           "means nothing else");
  std::error_code error;
  std::vector<TaughtWord> words;
  if (fs::exists(file, error)) words = load_words(file);
  auto word = find_word(words, name);
  if (word == words.end() && words.size() == kMostWords)
    refuse(file + " has " + std::to_string(kMostWords) +
           " words, which is the most: --forget one of them first");
  if (word == words.end()) word = words.insert(words.end(), {name, {}});
  std::vector<std::string> from = arguments.texts("recording");
  const std::size_t known = word->samples.size();
  check_count(*word, from.empty() ? kWanted : from.size());
  for (const std::string& recording : from)
    word->samples.push_back(sample_of(recording));
  if (from.empty()) {
    from = {arguments.text("source")};
    for (const Sample& sample : samples_of_microphone(from.front(), word->name, kWanted))
      word->samples.push_back(sample);
  }
  check_samples(*word, known, from);
  save(file, words);
  const auto allowed = allowed_distances(words);
  print_word(*word, allowed[static_cast<std::size_t>(word - words.begin())], words);
  warn(words, allowed);
}

void forget(const std::string& file, const std::string& name) {
  std::vector<TaughtWord> words = load_words(file);
  const auto word = find_word(words, name);
  if (word == words.end()) refuse(file + " has no word `" + name + "`: --list says which it has");
  words.erase(word);
  save(file, words);
}

void list(const std::string& file) {
  const std::vector<TaughtWord> words = load_words(file);
  const auto allowed = allowed_distances(words);
  for (std::size_t i = 0; i < words.size(); ++i)
    print_word(words[i], allowed[i], words);
  warn(words, allowed);
}

}  // namespace robosync::companion
