// command_words: detects which of a few words is said. pocketsphinx spots each of them in the sound (its search "kws"), with the
// English model of Debian's pocketsphinx-en-us.
//
// robosync-command-words --source FILE|MICROPHONE --period MS --word WORD… --strict N --shown_for S [--no-pace]
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <vector>

#include <pocketsphinx.h>
#include <unistd.h>

#include "companion/shown_word.hpp"
#include "companion/sound_source.hpp"
#include "companion/worker.hpp"

namespace robosync::companion {
namespace {

constexpr const char* kModel = "/usr/share/pocketsphinx/model/en-us/en-us";
constexpr const char* kDictionary = "/usr/share/pocketsphinx/model/en-us/cmudict-en-us.dict";
constexpr const char* kQuiet = "silence";
constexpr std::size_t kBlock =
    kSoundRate / 50;  // 20 ms: a word is not heard before the end of its last block
// Growth of pocketsphinx's threshold per sound: the longer a word, the less likely each way to say it.
constexpr double kPerSound = 0.2;

struct Word {
  std::string as_asked;    // in the program: `very_well`
  std::string as_spelled;  // in the dictionary: `very well`
};

std::string spelled(const std::string& word) {
  std::string result = word;
  for (char& c : result) {
    if (c == '_') c = ' ';
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return result;
}

class Decoder {
public:
  Decoder(const std::vector<Word>& words, double strict) {
    std::error_code error;
    if (!std::filesystem::exists(kDictionary, error))
      throw Failure(Exit::asked_wrongly,
                    "there is no model of English: install the package pocketsphinx-en-us");
    config_.reset(cmd_ln_init(nullptr, ps_args(), TRUE, "-hmm", kModel, "-dict", kDictionary,
                              "-logfn", "/dev/null", nullptr));
    if (config_) decoder_.reset(ps_init(config_.get()));
    if (!decoder_) throw Failure(Exit::outside, "pocketsphinx does not start");
    listen_for(words, strict);
    if (ps_start_utt(decoder_.get()) < 0) throw Failure(Exit::outside, "pocketsphinx fails");
  }

  // The word that is detected at the end of `samples`; empty: none.
  std::string hear(std::span<const std::int16_t> samples) {
    ps_process_raw(decoder_.get(), samples.data(), samples.size(), FALSE, FALSE);
    int32 score = 0;
    const char* const heard = ps_get_hyp(decoder_.get(), &score);
    if (heard == nullptr || *heard == '\0') return {};
    const std::string result = last_of(heard);
    ps_end_utt(decoder_.get());  // or it would be detected again
    if (ps_start_utt(decoder_.get()) < 0) throw Failure(Exit::outside, "pocketsphinx fails");
    return result;
  }

private:
  // The last of several words that ended within a block.
  std::string last_of(const char* heard) {
    std::string last;
    int latest = -1;
    for (ps_seg_t* seg = ps_seg_iter(decoder_.get()); seg != nullptr; seg = ps_seg_next(seg)) {
      int begin = 0, end = 0;
      ps_seg_frames(seg, &begin, &end);
      if (end > latest) {
        latest = end;
        last = ps_seg_word(seg);
      }
    }
    if (last.empty()) last = heard;
    return last.substr(0, last.find_last_not_of(' ') + 1);
  }

  std::size_t sounds_of(const std::string& phrase) {
    std::size_t sounds = 0;
    for (std::size_t at = 0; at < phrase.size();) {
      const std::size_t end = std::min(phrase.find(' ', at), phrase.size());
      const std::string word = phrase.substr(at, end - at);
      at = end + 1;
      if (word.empty()) continue;
      const std::unique_ptr<char, decltype(&ckd_free)> said(
          ps_lookup_word(decoder_.get(), word.c_str()), ckd_free);
      if (!said)
        throw Failure(Exit::asked_wrongly,
                      "`" + word + "` is not in the dictionary of English words (" + kDictionary +
                          "): compare with another word, or spell it as a dictionary does");
      const std::string text = said.get();
      sounds += 1 + static_cast<std::size_t>(std::ranges::count(text, ' '));
    }
    return sounds;
  }

  void listen_for(const std::vector<Word>& words, double strict) {
    std::string list;
    for (const Word& word : words) {
      const double exponent = std::max(
          0.0, static_cast<double>(sounds_of(word.as_spelled)) * (50 - strict) * kPerSound);
      list += word.as_spelled + " /1e-" + std::to_string(std::lround(exponent)) + "/\n";
    }
    const std::unique_ptr<FILE, int (*)(FILE*)> file(std::tmpfile(), std::fclose);
    if (!file || std::fputs(list.c_str(), file.get()) < 0 || std::fflush(file.get()) != 0)
      throw Failure(Exit::outside, "there is no room for a list of words in /tmp");
    const std::string path = "/proc/self/fd/" + std::to_string(fileno(file.get()));
    if (ps_set_kws(decoder_.get(), "words", path.c_str()) < 0 ||
        ps_set_search(decoder_.get(), "words") < 0)
      throw Failure(Exit::outside, "pocketsphinx does not take the words");
  }

  struct Free {
    void operator()(ps_decoder_t* decoder) const { ps_free(decoder); }
    void operator()(cmd_ln_t* config) const { cmd_ln_free_r(config); }
  };
  std::unique_ptr<cmd_ln_t, Free> config_;
  std::unique_ptr<ps_decoder_t, Free> decoder_;
};

void listen(const Arguments& arguments) {
  std::vector<Word> words;
  for (const std::string& word : arguments.words())
    if (word != kQuiet) words.push_back({word, spelled(word)});
  if (words.empty()) throw Failure(Exit::asked_wrongly, "there is no word to listen for");
  Decoder decoder(words, arguments.number("strict"));
  const auto source = open_sound(arguments.text("source"), arguments.no_pace());
  constexpr long kBlockMs = kBlock * 1000 / kSoundRate;
  constexpr int kAfter = 500 / kBlockMs;  // blocks of silence, for the last word to be detected
  ShownWord shown(kQuiet, arguments);
  std::vector<std::int16_t> block(kBlock);
  for (int after = 0; after < kAfter;) {
    const std::size_t count = source->read(block);
    std::fill(block.begin() + static_cast<std::ptrdiff_t>(count), block.end(), std::int16_t{0});
    if (count < kBlock) ++after;
    shown.pass(kBlockMs);
    const std::string phrase = decoder.hear(block);
    for (const Word& word : words)
      if (!phrase.empty() && word.as_spelled == phrase) shown.heard(word.as_asked);
  }
}

}  // namespace
}  // namespace robosync::companion

int main(int count, char** texts) {
  return robosync::companion::run(robosync::companion::listen, count, texts);
}
