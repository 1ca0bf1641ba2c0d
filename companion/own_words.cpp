// own_words: detects which of the words that somebody has taught it is said, in any language.
//
// robosync-own-words --source FILE|MICROPHONE --period MS --words FILE --word WORD… --strict N --shown_for S [--no-pace]
// robosync-own-words --words FILE --teach WORD (--recording FILE… | --source FILE|MICROPHONE)
// robosync-own-words --words FILE --forget WORD
// robosync-own-words --words FILE --list yes
#include <algorithm>
#include <string>
#include <vector>

#include "companion/bands.hpp"
#include "companion/matcher.hpp"
#include "companion/shown_word.hpp"
#include "companion/sound_source.hpp"
#include "companion/teaching.hpp"
#include "companion/utterances.hpp"
#include "companion/worker.hpp"

namespace robosync::companion {
namespace {

// The matcher compares all words in the file, because one that the program does not ask for must not be mistaken for one that it
// asks for.
void check_asked(const Arguments& arguments, const std::vector<TaughtWord>& words) {
  for (const std::string& asked : arguments.words())
    if (asked != kNoWord && std::ranges::find(words, asked, &TaughtWord::name) == words.end())
      throw Failure(Exit::asked_wrongly,
                    "`" + asked + "` is not in " + arguments.text("words") +
                        " any more: teach it again, or upload the program again");
}

void listen(const Arguments& arguments) {
  const std::vector<TaughtWord> words = load_words(arguments.text("words"));
  check_asked(arguments, words);
  Matcher matcher(words, arguments.number("strict"));
  const auto source = open_sound(arguments.text("source"), arguments.no_pace());
  ShownWord shown(std::string(kNoWord), arguments);
  Bands bands;
  Utterances utterances;
  constexpr int kAfter = 500 / kHopMs;  // blocks of silence, for the last word to be detected
  std::array<std::int16_t, kHop> block;
  for (int after = 0; after < kAfter;) {
    const std::size_t count = source->read(block);
    std::fill(block.begin() + static_cast<std::ptrdiff_t>(count), block.end(), std::int16_t{0});
    if (count < kHop) ++after;
    shown.pass(kHopMs);
    if (!utterances.hear(bands.hear(block))) continue;
    const auto word = matcher.match(utterances.last());
    if (word && std::ranges::count(arguments.words(), words[*word].name) != 0)
      shown.heard(words[*word].name);
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
