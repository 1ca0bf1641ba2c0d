// The time words, each by its sentence in docs/language.md: the whole past is kept, and looked
// through again in every step.
#pragma once

#include <cstdint>
#include <vector>

#include "tests/oracles/rsl/values.hpp"
#include "vm/image.hpp"

namespace robosync::oracle {

using Millis = std::int64_t;

struct Moment {
  std::int64_t step = 0;  // steps of one millisecond differ in this
  Millis at = 0;
};

// A time word as it is written; its conditions are the samples.
struct TimeWord {
  vm::TimerKind kind = vm::TimerKind::held;
  std::int64_t amount = 0;  // milliseconds; of CHANGES BY, thousandths
  std::size_t times = 0;    // of TIMES WITHIN
};

// What one time word was about in one step: a truth, two of them, or a number.
struct Sample {
  Moment when;
  Truth first, second;
  Number number;
};

class Past {
public:
  // A sample that is as the last one was is not kept: a stretch is its beginning.
  void add(const Sample& sample);
  // The word's truth in the step `now`, which is that of the last sample or later.
  [[nodiscard]] Truth truth(const TimeWord& word, Moment now) const;

private:
  [[nodiscard]] Truth held(Millis duration, Moment now) const;
  [[nodiscard]] Truth counted(std::size_t times, Millis within, Moment now) const;
  [[nodiscard]] Truth sequence(Millis within, Moment now) const;
  [[nodiscard]] Truth latched() const;
  [[nodiscard]] Truth rose(Moment now) const;
  [[nodiscard]] Truth changed(std::int64_t least, Moment now) const;

  std::vector<Sample> samples_;
};

}  // namespace robosync::oracle
