// The board's threads, as a table for people and as JSON.
#pragma once

#include <optional>
#include <span>
#include <string>

#include "link/messages.hpp"
#include "rsc/json.hpp"

namespace robosync::tool {

using ThreadList = std::span<const link::ThreadInfo>;

// `before` is an earlier list, from which each thread's share of the processor is worked out.
// Empty: no shares are shown.
[[nodiscard]] std::string threads_table(ThreadList now, ThreadList before);
// The load of all threads together, in percent of the processor.
[[nodiscard]] std::optional<double> load_of(ThreadList now, ThreadList before);
[[nodiscard]] Json threads_json(ThreadList now, ThreadList before);

}  // namespace robosync::tool
