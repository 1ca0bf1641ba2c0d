#include "tests/oracles/rsl/actuators.hpp"

#include <algorithm>

namespace robosync::oracle {
namespace {

constexpr std::size_t kMostWaiting = 8;
constexpr Millis kUsual = 1000;

Number given(const Order& order, vm::Param param) {
  for (const auto& [key, value] : order.given)
    if (key == param) return value;
  return std::nullopt;
}

// A virtual actuator takes as long as it is told: FOR, else OVER, else a second. STOP and what is
// unknown take no time.
Millis duration(const Order& order) {
  if (order.command->verb.action == vm::Action::stop) return 0;
  for (const auto& [param, value] : order.given)
    if (!value) return 0;
  const Number keep = given(order, vm::Param::for_);
  const Number over = given(order, vm::Param::over);
  return std::max<Millis>(keep.value_or(over.value_or(kUsual)), 0);
}

}  // namespace

Actuators::Actuators(const compiler::Program& program, const compiler::Robot& robot, Trace& trace)
    : trace_(trace), queues_(robot.actuators.size()) {
  for (const compiler::ActuatorConfig& actuator : robot.actuators)
    limits_.push_back({actuator.min, actuator.max, actuator.speed_limit});
  for (const auto& [actuator, speed] : program.speed_limits)
    limits_[actuator].speed = std::min<std::int64_t>(limits_[actuator].speed, speed);
}

bool Actuators::submit(std::size_t actuator, Order order) {
  const Limits& limits = limits_[actuator];
  for (auto& [param, value] : order.given) {
    if (value && param == vm::Param::to) value = std::clamp(*value, limits.least, limits.most);
    if (value && param == vm::Param::at) value = std::clamp<std::int64_t>(*value, 0, limits.speed);
  }
  Queue& queue = queues_[actuator];
  if (order.command->verb.action == vm::Action::stop) {
    if (queue.busy) cancel(actuator);
    queue.orders = {order};
    return true;
  }
  const std::size_t waiting = queue.orders.size() - (queue.busy ? 1 : 0);
  if (waiting >= kMostWaiting) return false;
  queue.orders.push_back(order);
  return true;
}

void Actuators::start(std::size_t actuator, Millis now) {
  Queue& queue = queues_[actuator];
  while (!queue.busy && !queue.halted && !queue.orders.empty()) {
    trace_.command(actuator, queue.orders.front());
    queue.busy = true;
    queue.ends = now + duration(queue.orders.front());
    if (queue.ends <= now) advance(actuator, now);
  }
}

void Actuators::cancel(std::size_t actuator) {
  trace_.actuator("cancel", actuator);
  queues_[actuator] = {};
}

void Actuators::halt(std::size_t actuator) {
  trace_.actuator("halt", actuator);
  queues_[actuator].busy = false;
  queues_[actuator].halted = true;
}

void Actuators::release(std::size_t actuator) {
  trace_.actuator("release", actuator);
  queues_[actuator].halted = false;
}

bool Actuators::advance(std::size_t actuator, Millis now) {
  Queue& queue = queues_[actuator];
  if (!queue.busy || queue.ends > now) return false;
  trace_.actuator("done", actuator);
  queue.busy = false;
  queue.orders.pop_front();
  start(actuator, now);
  return true;
}

bool Actuators::works_for(std::size_t rule) const {
  return std::any_of(queues_.begin(), queues_.end(), [&](const Queue& queue) {
    return std::any_of(queue.orders.begin(), queue.orders.end(),
                       [&](const Order& order) { return order.rule == rule; });
  });
}

}  // namespace robosync::oracle
