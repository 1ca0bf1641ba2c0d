// Response-time analysis: the longest time from a reading to a command, on one processor
// with fixed priorities.
//
// It knows nothing of images: task_set.hpp makes a TaskSet of a program. docs/timing.md derives
// the formulas. All times are executed instructions.
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

// What makes steps: a sensor, or something in the program that is due on its own. It is released
// at most once in `period`. Then its thread samples, and its announcement makes a step, alone or
// together with others.
struct Source {
  std::string name;
  Instructions period = 0;
  Instructions sample = 0;  // at the rank of its thread
  Instructions step = 0;    // made by its announcement alone; rules are evaluated, none fires
  unsigned rank = 0;        // 0: the step thread's own; the lower outranks; equals share a thread
  unsigned raised = 0;      // the best rank that adapted priorities can give it
  bool outranks_a_behavior = false;  // so it can announce while a step is under way
  bool may_outrank_one = false;      // … with adapted priorities
  // The source whose steps release this one, at most `delay` after they have begun; or
  // kNone. Two releases may then be closer together than `period`, by `jitter` (settle()).
  static constexpr std::size_t kNone = static_cast<std::size_t>(-1);
  std::size_t follows = kNone;
  Instructions delay = 0;
  Instructions early = 0;  // of a sample on a bus: how long before it is due it is asked for
  Instructions jitter = 0;
  // It is released this long after what it measures: an echo is under way meanwhile, and costs no work.
  Instructions measuring = 0;
  std::vector<std::string> actuators;  // that may be commanded in one of its steps
};

// A rule that fires: the cost of its response, in a step that one of `sources` has made.
struct Firing {
  std::string name;
  Instructions cost = 0;
  bool alternates = false;  // it fires on an edge: not in two consecutive evaluations
  std::vector<std::size_t> sources;
  Instructions gap = 0;       // it fires at most once in this time; 0: not known
  Instructions cooldown = 0;  // it wins at most once in this time, and then does not fire
  // In one step at most one of those with the same `choice` fires. Of those with the same
  // `contest` that fire, at most one wins; any other one takes TaskSet::lost. A choice is in a
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
  Instructions lost = 0;  // the cost of a rule that fires and loses; no firing costs less
  std::vector<Interference> interferences;
  Instructions longest_lock = 0;  // the longest critical section of a thread below them
  // The line of a WAIT that may take no time, because of which a source is released that often; 0: the
  // line is not known.
  static constexpr unsigned kNoWait = ~0U;
  unsigned short_wait = kNoWait;
};

enum class Priorities : std::uint8_t {
  base,     // as written
  adapted,  // every other behaviour as high as it can get
};

// A share of a response time, and what it is for. Lists have the largest first.
struct Contributor {
  std::string name;
  Instructions cost = 0;
};

// Shares of the same name are added up: for the reader they are one thing.
void add_share(std::vector<Contributor>& shares, const std::string& name, Instructions cost);

struct ResponseTime {
  Instructions time = 0;  // from the source's release to the command; if unbounded, so far
  bool bounded = false;   // false: the processor never finishes what outranks it
  std::vector<Contributor> contributors;
};

// Computes the jitter of the sources that follow others. Before response_time_of().
void settle(TaskSet& set, Priorities priorities);

// The share of the processor that one rule takes.
[[nodiscard]] double utilization(const TaskSet& set, const Firing& rule);
// The share of the processor that everything takes together; above 1 it is overloaded.
[[nodiscard]] double utilization(const TaskSet& set);

// From the asking for a sensor's sample to the end of the step that contains its announcement: all of it is work in one stretch,
// which is idle while the bus works. Never less than what passes, and mostly less than the jitter and the response time together.
// Unbounded if it is not asked.
[[nodiscard]] ResponseTime response_time_from_asking(const TaskSet& set, std::size_t source,
                                                     Priorities priorities);

// From the release of a source to the end of the step that contains its announcement.
[[nodiscard]] ResponseTime response_time_of(const TaskSet& set, std::size_t source,
                                            Priorities priorities);

}  // namespace robosync::analysis
