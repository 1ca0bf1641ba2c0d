// Trace events as text: names instead of numbers. One formatter for `rsc run` and `rsc monitor`.
#pragma once

#include <string>
#include <vector>

#include "link/events.hpp"
#include "link/messages.hpp"
#include "rsc/program.hpp"
#include "vm/image.hpp"

namespace robosync::tool {

// The names behind the numbers in events. `image` must outlive it. Without an image, or for a
// number that it does not have, the number itself is shown.
struct TraceNames {
  const vm::Image* image = nullptr;
  std::vector<link::ThreadInfo> threads;  // by rank; may be empty
  const Origin* origin = nullptr;         // what the source says about names, if known
};

// Does the event name a thread by its rank?
[[nodiscard]] bool names_thread(const link::Event& event);

// One JSON object without newline: t_us, step, event, names, values, source line.
[[nodiscard]] std::string trace_json(const link::Event& event, const TraceNames& names);

// "touch LEVEL = 2", and the same after its time: "   0.020 s  touch LEVEL = 2".
[[nodiscard]] std::string trace_words(const link::Event& event, const TraceNames& names);
[[nodiscard]] std::string trace_line(const link::Event& event, const TraceNames& names);

}  // namespace robosync::tool
