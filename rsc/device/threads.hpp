// What the board says of its threads, as a table for people and as JSON.
#pragma once

#include <optional>
#include <span>
#include <string>

#include <nlohmann/json_fwd.hpp>

#include "link/messages.hpp"

namespace robosync::tool {

using ThreadList = std::span<const link::ThreadInfo>;

// `before` is an earlier list: between the two each thread's share of the processor is told. Empty:
// there is none, and no shares are told.
[[nodiscard]] std::string threads_table(ThreadList now, ThreadList before);
// All of them together, in percent of the processor.
[[nodiscard]] std::optional<double> load_of(ThreadList now, ThreadList before);
[[nodiscard]] nlohmann::ordered_json threads_json(ThreadList now, ThreadList before);

}  // namespace robosync::tool
