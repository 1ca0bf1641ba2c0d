// The output WORD: says what is heard at once, and otherwise once a period what stays.
#pragma once

#include <string>

#include "companion/worker.hpp"

namespace robosync::companion {

class ShownWord {
public:
  // `quiet`: what is said where nothing was heard. --period and --shown_for.
  ShownWord(std::string quiet, const Arguments& arguments);

  void heard(const std::string& word);
  // So much sound has been heard.
  void pass(long ms);

private:
  void tell();

  std::string quiet_;
  long period_, shown_for_;               // in ms, as all times here
  long time_ = 0, until_ = 0, told_ = 0;  // in sound
  std::string now_;
};

}  // namespace robosync::companion
