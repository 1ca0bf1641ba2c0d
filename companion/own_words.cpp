// own_words: detects which of the words that somebody has taught it is said, in any language.
//
// robosync-own-words --source FILE|MICROPHONE --period MS --words FILE --word WORD… --strict N --shown_for S [--no-pace]
// robosync-own-words --words FILE --teach WORD (--recording FILE… | --source FILE|MICROPHONE)
// robosync-own-words --words FILE --forget WORD
// robosync-own-words --words FILE --list yes
#include "runtime-m4/algorithms/own_words.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "companion/hearing.hpp"
#include "companion/shown_word.hpp"
#include "companion/teaching.hpp"
#include "companion/worker.hpp"
#include "runtime-m4/algorithms/modules.hpp"

namespace robosync::companion {
namespace {

// All words in the file are compared, because one that the program does not ask for must not be mistaken for one that it asks for.
void check_asked(const Arguments& arguments, const std::vector<TaughtWord>& words) {
  for (const std::string& asked : arguments.words())
    if (asked != kNoWord && std::ranges::find(words, asked, &TaughtWord::name) == words.end())
      throw Failure(Exit::asked_wrongly,
                    "`" + asked + "` is not in " + arguments.text("words") +
                        " any more: teach it again, or upload the program again");
}

std::int32_t thousandths(double number) {
  return static_cast<std::int32_t>(std::lround(number * 1000));
}

// The module of the firmware. Here it need not wait for the next 20 ms to go on with its work.
class Module {
public:
  Module(const std::vector<TaughtWord>& words, const Arguments& arguments)
      : constants_(constants_of(words)),
        config_{thousandths(arguments.number("strict")),
                thousandths(arguments.number("shown_for"))},
        state_(own_words_module.state_bytes(config_.data()) / sizeof(std::uint64_t) + 1) {
    own_words_module.init(state_.data(), config_.data(), kFrameMs);
  }

  // The index of the word that is shown after this frame, or nothing.
  std::optional<std::size_t> hear(const own_words_frame& frame) {
    std::array<std::int32_t, OWN_WORDS_VALUES> inputs;
    std::ranges::transform(frame.values, inputs.begin(),
                           [](std::uint32_t value) { return static_cast<std::int32_t>(value); });
    const robosync_block block = {inputs.data(), &word_, config_.data()};
    show();
    own_words_module.process(state_.data(), nullptr, &block);
    std::size_t word = static_cast<std::size_t>(word_ / ROBOSYNC_ONE);
    while (own_words_is_busy(state_.data()) != 0) {
      show();
      word = own_words_go_on(state_.data(), &block);
    }
    if (word == 0) return std::nullopt;
    return word - 1;
  }

private:
  void show() {
    robosync_show(reinterpret_cast<robosync_taught*>(state_.data()), constants_.data(),
                  static_cast<std::uint32_t>(constants_.size()));
  }

  std::vector<std::int32_t> constants_;
  std::array<std::int32_t, 2> config_;
  std::vector<std::uint64_t> state_;
  std::int32_t word_ = ROBOSYNC_UNKNOWN;
};

void listen(const Arguments& arguments) {
  const std::vector<TaughtWord> words = load_words(arguments.text("words"));
  check_asked(arguments, words);
  Module module(words, arguments);
  Hearing hearing(arguments.text("source"), arguments.no_pace());
  ShownWord shown(std::string(kNoWord), arguments);
  constexpr int kAfter = 500 / kFrameMs;  // frames of silence, for the last word to be heard
  own_words_frame frame;
  for (int after = 0; after < kAfter;) {
    if (!hearing.next(frame)) ++after;
    shown.pass(kFrameMs);
    const auto word = module.hear(frame);
    const bool is_asked = word && std::ranges::count(arguments.words(), words[*word].name) != 0;
    shown.show(is_asked ? words[*word].name : std::string(kNoWord));
  }
}

void work(const Arguments& arguments) {
  if (arguments.has("teach"))
    teach(arguments);
  else if (arguments.has("forget"))
    forget(arguments.text("words"), arguments.text("forget"));
  else if (arguments.has("list"))
    list(arguments.text("words"));
  else
    listen(arguments);
}

}  // namespace
}  // namespace robosync::companion

int main(int count, char** texts) {
  return robosync::companion::run(robosync::companion::work, count, texts);
}
