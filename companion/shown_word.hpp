// The output WORD: reports a heard word immediately, and repeats the present value once a period.
#pragma once

#include <string>

#include "companion/worker.hpp"

namespace robosync::companion {

class ShownWord {
public:
  // `quiet`: the value when nothing was heard. Uses --period and --shown_for.
  ShownWord(std::string quiet, const Arguments& arguments);

  void heard(const std::string& word);
  // The word that is shown now, until another call.
  void show(const std::string& word);
  // Call it after each piece of sound, with its length.
  void pass(long ms);

private:
  void tell();

  std::string quiet_;
  long period_, shown_for_;               // in ms, as all times here
  long time_ = 0, until_ = 0, told_ = 0;  // positions in the sound
  std::string now_;
};

}  // namespace robosync::companion
