// See introduction.hpp.
#include "rsc/device/introduction.hpp"

#include "rsc/device/orders.hpp"
#include "rsc/json.hpp"
#include "rsc/names.hpp"

namespace robosync::tool {

Json robot_json(const link::HelloReply& board) {
  const std::string name = text_of(board.robot);
  return name.empty() ? Json() : Json(name);
}

Json introduction_json(const link::HelloReply& board, const Past& past,
                       const std::vector<OnBus>& silent) {
  return {{"name", text_of(board.board)},       {"robot", robot_json(board)},
          {"uptime_us", past.status.uptime_us}, {"reset_reason", reset_reason(past.status)},
          {"faults", past.status.faults},       {"last_fault", last_fault_json(past)},
          {"owner", owner_json(past.owner)},    {"silent", devices_json(silent)}};
}

}  // namespace robosync::tool
