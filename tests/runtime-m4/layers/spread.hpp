// A program of many independent rules, and its robot: rule r fires when
// channel r modulo the number of channels measures kFirstValue + r / the number of channels.
#pragma once

#include <string>

namespace robosync::test {

struct Spread {
  unsigned rules;
  unsigned behaviors;     // each gets an equal share of the rules
  unsigned channels;      // in sensors of 8
  std::string text = "";  // in each rule's LOG, after its number

  static constexpr int kFirstValue = 10;  // so that no rule reacts to 0

  unsigned channel_of(unsigned rule) const { return rule % channels; }
  int value_of(unsigned rule) const { return kFirstValue + static_cast<int>(rule / channels); }
  std::string rsl() const;
  std::string json() const;
};

}  // namespace robosync::test
