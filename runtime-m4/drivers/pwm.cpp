// Duty cycle in percent on a PWM pin, of the 20 ms frame. TO or AT sets it, OVER goes there evenly;
// FOR keeps it up for a time and then switches off. Without FOR it stays. Neither TO nor AT: full.
#include <algorithm>

#include "runtime-m4/drivers/drivers.hpp"
#include "runtime-m4/policy/rules.hpp"

namespace robosync::drivers::pwm {
namespace {

constexpr vm::Value kFull = 100 * vm::kScale;
constexpr std::uint32_t kFrame = 20'000;  // microseconds
constexpr kernel::Duration kSetpointPeriod = kernel::milliseconds(policy::kSetpointPeriodMs);

void output(const Device& device, vm::Value percent, kernel::Time now) {
  const auto duty = static_cast<std::uint64_t>(std::clamp(percent, vm::Value{0}, kFull));
  device.drive(static_cast<std::uint32_t>(duty * kFrame / std::uint64_t{kFull}), now);
}

void jump(const Device& device, vm::Value percent, kernel::Time now) {
  device.state.motion = {.from = percent, .to = percent, .begin = now, .length = 0};
  output(device, percent, now);
}

}  // namespace

kernel::Time start(const Device& device, const Order& order, kernel::Time now) {
  const vm::Value present = device.state.motion.at(now);
  const vm::Value level = order.get(vm::Param::to, order.get(vm::Param::at, kFull));
  device.state.until = 0;
  if (order.action == vm::Action::stop) {
    jump(device, 0, now);
    return kDone;
  }
  const kernel::Duration over = duration_of(order.get(vm::Param::over, 0));
  device.state.motion = {.from = present, .to = level, .begin = now, .length = over};
  if (order.has(vm::Param::for_))
    device.state.until =
        std::max<kernel::Time>(now + over + duration_of(order.get(vm::Param::for_, 0)), 1);
  return advance(device, now);
}

kernel::Time advance(const Device& device, kernel::Time now) {
  const Motion& motion = device.state.motion;
  output(device, motion.at(now), now);
  if (now < motion.end()) return std::min(motion.end(), now + kSetpointPeriod);
  if (now < device.state.until) return device.state.until;
  if (device.state.until != 0) jump(device, 0, now);
  return kDone;
}

void release(const Device& device, vm::Release how, kernel::Time now) {
  jump(device, how == vm::Release::hold ? device.state.motion.at(now) : 0, now);
}

}  // namespace robosync::drivers::pwm
