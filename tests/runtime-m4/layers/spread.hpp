// A program of many rules that have nothing to do with each other, and its robot: rule r fires when
// channel r modulo the number of channels is measured as kFirstValue + r / the number of channels.
#pragma once

#include <string>

namespace robosync::test {

struct Spread {
  unsigned rules;
  unsigned behaviors;     // the rules are dealt out in equal parts
  unsigned channels;      // in sensors of 8
  std::string text = "";  // of each rule's LOG, behind its number

  static constexpr int kFirstValue = 10;  // so that 0 means nothing to any rule

  unsigned channel_of(unsigned rule) const { return rule % channels; }
  int value_of(unsigned rule) const { return kFirstValue + static_cast<int>(rule / channels); }
  std::string rsl() const;
  std::string json() const;
};

}  // namespace robosync::test
