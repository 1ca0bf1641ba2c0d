// See power.hpp.
#include "runtime-m4/drivers/power.hpp"

#include <algorithm>

#include "runtime-m4/policy/rules.hpp"

namespace robosync::drivers::power {
namespace {

constexpr kernel::Duration kSetpointPeriod = kernel::milliseconds(policy::kSetpointPeriodMs);

void stay(const Device& device, vm::Value level, kernel::Time now) {
  device.state.motion = {.from = level, .to = level, .begin = now, .length = 0};
}

}  // namespace

void begin(const Device& device, const Order& order, vm::Value level, kernel::Time now) {
  device.state.until = 0;
  if (order.action == vm::Action::stop) return stay(device, 0, now);
  const vm::Value present = device.state.motion.at(now);
  const kernel::Duration over = duration_of(order.get(vm::Param::over, 0));
  device.state.motion = {.from = present, .to = level, .begin = now, .length = over};
  if (order.has(vm::Param::for_))
    device.state.until =
        std::max<kernel::Time>(now + over + duration_of(order.get(vm::Param::for_, 0)), 1);
}

kernel::Time advance(const Device& device, kernel::Time now) {
  const kernel::Time end = device.state.motion.end();
  if (now < end) return std::min(end, now + kSetpointPeriod);
  if (now < device.state.until) return device.state.until;
  if (device.state.until != 0) stay(device, 0, now);
  return kDone;
}

void stop(const Device& device, vm::Release how, kernel::Time now) {
  stay(device, how == vm::Release::hold ? device.state.motion.at(now) : 0, now);
}

}  // namespace robosync::drivers::power
