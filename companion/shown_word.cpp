// See shown_word.hpp.
#include "companion/shown_word.hpp"

#include <cmath>
#include <limits>
#include <utility>

namespace robosync::companion {

ShownWord::ShownWord(std::string quiet, const Arguments& arguments)
    : quiet_(std::move(quiet)),
      period_(arguments.period().count()),
      shown_for_(std::lround(arguments.number("shown_for") * 1000)),
      now_(quiet_) {
  say("WORD", quiet_);
}

void ShownWord::heard(const std::string& word) {
  now_ = word;
  until_ = time_ + shown_for_;
  tell();
}

void ShownWord::show(const std::string& word) {
  until_ = std::numeric_limits<long>::max();
  if (word == now_) return;
  now_ = word;
  tell();
}

void ShownWord::pass(long ms) {
  time_ += ms;
  const bool over = now_ != quiet_ && time_ >= until_;
  if (over) now_ = quiet_;
  if (over || time_ >= told_ + period_) tell();
}

void ShownWord::tell() {
  say("WORD", now_);
  told_ = time_;
}

}  // namespace robosync::companion
