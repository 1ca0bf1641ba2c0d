// How a board introduces itself, for `rsc monitor`, `rsc bridge` and `rsc info`.
#pragma once

#include <vector>

#include "link/messages.hpp"
#include "rsc/device/devices.hpp"
#include "rsc/device/past.hpp"
#include "rsc/json.hpp"

namespace robosync::tool {

// The robot's own name; null if it has none.
[[nodiscard]] Json robot_json(const link::HelloReply& board);
// Which board and robot it is, what it remembers, whose it is, and which of its devices do not answer.
[[nodiscard]] Json introduction_json(const link::HelloReply& board, const Past& past,
                                     const std::vector<OnBus>& silent);

}  // namespace robosync::tool
