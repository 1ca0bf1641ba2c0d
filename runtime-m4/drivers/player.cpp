// A sound player with numbered tracks. A track plays for FOR, or else for the length that robot.json gives it, or else for a
// second, and is then ended: nothing here knows how long its file is.
#include "runtime-m4/drivers/timed.hpp"

namespace robosync::drivers::player {

kernel::Time start(const Device& device, const Order& order, kernel::Time now) {
  const kernel::Time end = take_time(device, order, now);
  const vm::Value track = order.get(vm::Param::item, 0) / vm::kScale;
  device.play(end == kDone ? std::uint16_t{0} : static_cast<std::uint16_t>(track));
  return end;
}

kernel::Time advance(const Device& device, kernel::Time now) {
  const kernel::Time end = go_on(device, now);
  if (end == kDone) device.play(0);
  return end;
}

// A sound cannot be held.
void release(const Device& device, vm::Release, kernel::Time) {
  device.play(0);
}

}  // namespace robosync::drivers::player
