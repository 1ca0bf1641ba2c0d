// What holds on a board when somebody begins to watch it: what is tripped and halted, and the values that are known.
#pragma once

#include <string>
#include <vector>

#include "link/events.hpp"
#include "rsc/device/client.hpp"
#include "rsc/json.hpp"
#include "rsc/trace/trace_format.hpp"

namespace robosync::tool {

struct Current {
  bool stopped = false;  // by a person
  // The events that would have told it, all with the time of the question: input, set, trip, halt.
  std::vector<link::Event> events;
};

// `image`: of the running program; null: none.
[[nodiscard]] Current current_of(Client& client, const vm::Image* image);

// One line for each thing that keeps outputs in their safe state: a person, a tripped rule, a halted actuator.
struct Held {
  std::string what, text;  // "tripped", "safety rule at line 10"
};
[[nodiscard]] std::vector<Held> held_back(const Current& current, const TraceNames& names);
// {"stopped": false, "tripped": [{"rule": 0, "line": 10}], "halted": ["wheel"]}
[[nodiscard]] Json current_json(const Current& current, const TraceNames& names);

}  // namespace robosync::tool
