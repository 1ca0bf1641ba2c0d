// What the board says of its threads, as a table for people and as JSON.
#pragma once

#include <span>
#include <string>

#include <nlohmann/json_fwd.hpp>

#include "link/messages.hpp"

namespace robosync::tool {

using ThreadList = std::span<const link::ThreadInfo>;

// `before` is an earlier list: between the two each thread's share of the processor is told. Empty:
// there is none, and no shares are told.
[[nodiscard]] std::string threads_table(ThreadList now, ThreadList before);
[[nodiscard]] nlohmann::ordered_json threads_json(ThreadList now, ThreadList before);

}  // namespace robosync::tool
