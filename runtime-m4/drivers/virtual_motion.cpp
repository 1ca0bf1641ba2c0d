// A virtual actuator that moves like the real one: its commands are seen in the trace. It knows
// where it is, and no command moves it faster than its speed limit. With a speed of its own
// (vm::VirtualMotion says where that is stored) it takes way / speed. Without one, and for everything that is
// not a movement, it takes as long as FOR or OVER says, or one second if neither is given. One with a limit of acceleration has a
// speed of its own.
#include <algorithm>

#include "runtime-m4/drivers/timed.hpp"
#include "runtime-m4/drivers/way.hpp"

namespace robosync::drivers::virtual_motion {
namespace {

bool moves(const Device& device, const Order& order) {
  if (order.action != vm::Action::move && order.action != vm::Action::follow) return false;
  const bool sweeps = device.wiring.bus == static_cast<unsigned>(vm::VirtualMotion::sweeps);
  return way::has_target(order) || sweeps;
}

// As long as the order says, within the speed limit. Not inlined: never on the stack together with way::start().
[[gnu::noinline]] kernel::Time move_in_time(const Device& device, const Order& order,
                                            kernel::Time now) {
  const kernel::Time told = take_time(device, order, now);
  const vm::Value from = device.state.motion.at(now);
  const vm::Value to = way::target_of(device, order, now);
  const kernel::Duration least = travel_time(from, to, device.wiring.speed_limit);
  const kernel::Time end = std::max(told == kDone ? now : told, now + least);
  device.state.motion = {.from = from, .to = to, .begin = now, .length = end - now};
  return end == now ? kDone : end;
}

kernel::Time until_arrived(const Device& device) {
  device.state.until = device.state.motion.end();
  return device.state.until;
}

}  // namespace

kernel::Time start(const Device& device, const Order& order, kernel::Time now) {
  if (!device.state.placed) way::stand_at_rest(device, now);
  way::stop(device, vm::Release::hold, now);
  if (order.action == vm::Action::stop && way::brake(device, now)) return until_arrived(device);
  if (!moves(device, order)) return take_time(device, order, now);
  if (device.wiring.pin == 0) {
    device.state.until = move_in_time(device, order, now);
    return device.state.until;
  }
  const auto usual = static_cast<vm::Value>(device.wiring.pin) * vm::kScale;
  return way::start(device, order, usual, now) ? until_arrived(device) : kDone;
}

kernel::Time advance(const Device& device, kernel::Time now) {
  if (now < device.state.until || !way::next_leg(device, now)) return go_on(device, now);
  return until_arrived(device);
}

void release(const Device& device, vm::Release how, kernel::Time now) {
  way::stop(device, how, now);
  device.state.legs = 0;
}

}  // namespace robosync::drivers::virtual_motion
