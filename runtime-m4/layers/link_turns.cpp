// See link_turns.hpp.
#include "runtime-m4/layers/link_turns.hpp"

#include "runtime-m4/policy/link_share.hpp"

namespace robosync::layers {

void LinkTurns::start(std::uint32_t step_cost) {
  has_heard(asked());
  heard_before_ = heard() - 1;
  pause_ = 0;
  patience_ = policy::link_patience_us(step_cost);
}

bool LinkTurns::is_time(const Now& now) {
  if (heard_before_ != heard()) {
    heard_before_ = heard();
    since_ = now.time;
  }
  return now.time - since_ >= patience_ && has_budget(now);
}

// The clock wraps after minutes, and no pause is as long as a second.
bool LinkTurns::has_budget(const Now& now) const {
  return now.clock - last_.clock >= pause_ || now.time - last_.time >= kernel::milliseconds(1000);
}

void LinkTurns::took(const Now& begin, const Now& end) {
  last_ = begin;
  pause_ = policy::kLinkParts * (end.clock - begin.clock);
}

}  // namespace robosync::layers
