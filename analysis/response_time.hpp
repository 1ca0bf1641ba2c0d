// Response-time analysis: how long a reading can take at most to become a command, on one processor
// with fixed priorities.
//
// It knows nothing of images: task_set.hpp makes a TaskSet of a program. docs/timing.md derives
// what is computed here. All times are executed instructions.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace robosync::analysis {

using Instructions = std::uint64_t;

constexpr Instructions ceil_div(Instructions a, Instructions b) {
  return (a + b - 1) / b;
}

// What makes steps: a sensor, or something in the program that is due by itself. It is released
// once in `period` at most; then its thread samples, and its announcement makes a step, alone or
// together with others.
struct Source {
  std::string name;
  Instructions period = 0;
  Instructions sample = 0;  // at the rank of its thread
  Instructions step = 0;    // that its announcement alone has made; rules are evaluated, none fires
  unsigned rank = 0;    // 0: of the step thread itself; the lower outranks; equals share a thread
  unsigned raised = 0;  // the best rank that adapted priorities can give it
  bool outranks_a_behavior = false;  // so it can announce while a step is under way
  bool may_outrank_one = false;      // … with adapted priorities
  // The source whose steps release this one, a moment of at most `delay` after they have begun; or
  // kNone. Then two releases may come nearer to each other than `period`, by `jitter` (settle()).
  static constexpr std::size_t kNone = static_cast<std::size_t>(-1);
  std::size_t follows = kNone;
  Instructions delay = 0;
  Instructions jitter = 0;
  // It is released so long after what it measures: an echo is on its way meanwhile, and costs no work.
  Instructions measuring = 0;
  std::vector<std::string> actuators;  // that may be commanded in a step of its
};

// A rule that fires: what its response costs, in a step that one of `sources` has made.
struct Firing {
  std::string name;
  Instructions cost = 0;
  bool alternates = false;  // it fires on an edge: not in two evaluations that follow each other
  std::vector<std::size_t> sources;
  Instructions gap = 0;       // in this time it fires once at most; 0: not known
  Instructions cooldown = 0;  // in this time it wins once at most, and does not fire after that
  // In one step, one at most of those with the same `choice` fires, and of those with the same
  // `contest` that fire, one at most wins; another one takes TaskSet::lost. A choice is in a
  // contest as a whole or not at all.
  static constexpr std::size_t kNone = static_cast<std::size_t>(-1);
  std::size_t choice = kNone;
  std::size_t contest = kNone;
};

// What outranks all sources: interrupts, the safety thread, actuators that are moving.
struct Interference {
  std::string name;
  Instructions period = 0;
  Instructions cost = 0;
};

struct TaskSet {
  std::vector<Source> sources;
  std::vector<Firing> firings;
  Instructions lost = 0;  // of a rule that fires and loses; no firing costs less
  std::vector<Interference> interferences;
  Instructions longest_lock = 0;  // the longest critical section of a thread below them
  // Line of a WAIT that may take no time, for which a source comes as often as that; 0: the line is
  // not known.
  static constexpr unsigned kNoWait = ~0U;
  unsigned short_wait = kNoWait;
};

enum class Priorities : std::uint8_t {
  base,     // as written
  adapted,  // every other behaviour as high as it can get
};

// What a share of a response time is for, the largest first.
struct Contributor {
  std::string name;
  Instructions cost = 0;
};

// What has one name is one thing for who reads of it.
void add_share(std::vector<Contributor>& shares, const std::string& name, Instructions cost);

struct ResponseTime {
  Instructions time = 0;  // from the release of the source to the command; when unbounded, so far
  bool bounded = false;   // false: the processor is never done with what outranks it
  std::vector<Contributor> contributors;
  [[nodiscard]] bool in_time(const Source& source) const {
    return bounded && time <= source.period;
  }
};

// Works out the jitter of the sources that follow others. Before response_time_of().
void settle(TaskSet& set, Priorities priorities);

// Of one rule, the share of the processor.
[[nodiscard]] double utilization(const TaskSet& set, const Firing& rule);
// The share of the processor that all of it takes together; above 1 it cannot be done.
[[nodiscard]] double utilization(const TaskSet& set);

// From the release of a source to the end of the step that has its announcement.
[[nodiscard]] ResponseTime response_time_of(const TaskSet& set, std::size_t source,
                                            Priorities priorities);

}  // namespace robosync::analysis
