// A naive simulation of a task set (analysis/response_time.hpp), event by event, for holding the
// analysis against. It shares the description of the set with the analysis, and no code.
//
// One processor. Interference first; then a step that is under way, up to where its behaviours run,
// which sensors may outrank; then sampling, by rank. What was announced is latched all at once when
// no step is under way. Merged steps cost the sum of what they are made of. A rule that fires on an
// edge has a truth that is drawn anew for each evaluation.
#pragma once

#include <cstdint>
#include <random>
#include <vector>

#include "analysis/response_time.hpp"

namespace robosync::test {

using Time = std::uint64_t;

// When sources and interferences are released: the first time, and the pauses between.
struct Pattern {
  std::vector<Time> first;  // by source; those that follow others have none
  std::vector<Time> interference_first;
  double laziness =
      0;              // 0: as often as they may; else up to this share of a period later each time
  double truth = 1;   // the chance that a condition that may alternate is true; 1: at first sight
  bool locks = true;  // a thread below all takes the longest lock whenever nobody else runs
  Time behaviors_begin = 0;  // after this of a step's work, its behaviours run
  Time follow_delay = 1;     // from a step to what follows it
};

// The longest time from a release to the end of the step with its announcement, by source, among
// the releases before `horizon`.
[[nodiscard]] std::vector<Time> simulate(const analysis::TaskSet& set, const Pattern& pattern,
                                         Time horizon, std::mt19937& random);

}  // namespace robosync::test
