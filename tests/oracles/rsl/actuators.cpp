#include "tests/oracles/rsl/actuators.hpp"

#include <algorithm>
#include <cstdlib>
#include <optional>
#include <utility>

#include "compiler/ir/walk.hpp"

namespace robosync::oracle {
namespace {

constexpr std::size_t kMostWaiting = 8;
// For all actuators that the program uses together.
constexpr std::size_t kPlaces = 16;
constexpr std::size_t kPlacesEach = 2;
constexpr Millis kUsual = 1000;
constexpr std::int64_t kFrame = 20'000;  // no movement is shorter, in microseconds
constexpr std::int64_t kMostGestures = 1000;

Number given(const Order& order, vm::Param param) {
  for (const auto& [key, value] : order.given)
    if (key == param) return value;
  const auto& word = order.command->word;
  return word && word->param == param ? Number(word->value) : std::nullopt;
}

// What has no way to go takes as long as it is told: FOR, else OVER, else a second.
Millis told(const Order& order) {
  const Number keep = given(order, vm::Param::for_);
  const Number over = given(order, vm::Param::over);
  return std::max<Millis>(keep.value_or(over.value_or(kUsual)), 0);
}

// In microseconds.
std::optional<std::int64_t> travel(std::int64_t way, std::int64_t speed) {
  if (way == 0) return 0;
  if (speed <= 0) return std::nullopt;
  return std::abs(way) * 1'000'000 / speed;
}

bool speed_is_of_way(const compiler::ActuatorConfig& actuator) {
  if (actuator.to_unit == nullptr || actuator.at_unit == nullptr) return false;
  using vm::Dimension;
  const std::pair way{actuator.to_unit->dimension, actuator.at_unit->dimension};
  return way == std::pair{Dimension::angle, Dimension::angular_speed} ||
         way == std::pair{Dimension::length, Dimension::speed} ||
         way == std::pair{Dimension::percent, Dimension::percent};
}

}  // namespace

Actuators::Actuators(const compiler::ir::Program& program, const compiler::Robot& robot,
                     Trace& trace)
    : program_(program), trace_(trace), queues_(robot.actuators.size()) {
  for (const compiler::ActuatorConfig& actuator : robot.actuators) {
    const bool goes = speed_is_of_way(actuator);
    limits_.push_back({actuator.min, actuator.max, actuator.speed_limit,
                       goes ? std::int64_t{actuator.usual_speed} * 1000 : 0, goes,
                       goes && actuator.sweeps});
    on_release_.push_back(actuator.on_release);
    safe_.push_back(actuator.safe);
  }
  compiler::for_each_rule(program, [this](const compiler::ir::Rule& rule) {
    for (const auto* block : {&rule.then_response, &rule.else_response})
      compiler::for_each_statement(*block, [this](const compiler::ir::Statement& statement) {
        if (const auto* command = std::get_if<compiler::ir::Command>(&statement.node))
          used_.insert(command->actuators.begin(), command->actuators.end());
        if (const auto* halt = std::get_if<compiler::ir::Halt>(&statement.node))
          used_.insert(halt->actuators.begin(), halt->actuators.end());
      });
  });
  for (const auto& [actuator, speed] : program.speed_limits)
    limits_[actuator].speed = std::min<std::int64_t>(limits_[actuator].speed, speed);
  for (std::size_t a = 0; a < queues_.size(); ++a)
    let_go(a, vm::Release::rest, 0);
}

std::int64_t Actuators::Motion::at(Millis now) const {
  const Millis passed = now - begin, whole = length / 1000;
  if (passed * 1000 >= length || whole == 0) return to;
  return passed <= 0 ? from : from + (to - from) * passed / whole;
}

// It stays where it is, or goes to rest: 0, or the end of its range next to it.
void Actuators::let_go(std::size_t actuator, vm::Release how, Millis now) {
  const Limits& limits = limits_[actuator];
  Queue& queue = queues_[actuator];
  const std::int64_t rest = std::clamp<std::int64_t>(0, limits.least, limits.most);
  const std::int64_t place = how == vm::Release::rest ? rest : queue.motion.at(now);
  queue.motion = {place, place, now, 0};
  queue.legs = 0;
}

void Actuators::go(std::size_t actuator, std::int64_t to, std::int64_t length, Millis now) {
  Motion& motion = queues_[actuator].motion;
  motion = {motion.at(now), to, now, std::max(length, kFrame)};
}

// "To its range's end, to its beginning, and back to where it was." Where it is already it need not go. False: that was all.
bool Actuators::next_leg(std::size_t actuator, Millis now) {
  Queue& queue = queues_[actuator];
  const Limits& limits = limits_[actuator];
  const std::int64_t targets[] = {limits.most, queue.home, limits.least};
  const std::int64_t here = queue.motion.at(now);
  while (queue.legs > 0 && targets[queue.legs % 3] == here)
    --queue.legs;
  if (queue.legs == 0) return false;
  const std::int64_t to = targets[queue.legs-- % 3];
  go(actuator, to, *travel(to - here, queue.speed), now);
  return true;
}

// "They take what the real one would", and no command goes faster than the limit. How long, the first leg
// of a gesture for the whole of it; 0: it is done at once.
Millis Actuators::begin(std::size_t actuator, const Order& order, Millis now) {
  const Limits& limits = limits_[actuator];
  Queue& queue = queues_[actuator];
  let_go(actuator, vm::Release::hold, now);
  queue.keys.clear();
  queue.motion_ends = now;
  if (order.command->verb.action == vm::Action::stop) return 0;
  for (const auto& [param, value] : order.given)
    if (!value) return 0;
  if (order.command->motion) {
    begin_motion(actuator, order, now);
    return go_to_next_key(actuator, now);
  }
  const Number to = given(order, vm::Param::to), by = given(order, vm::Param::by);
  const Number over = given(order, vm::Param::over);
  const bool follows = order.command->verb.action == vm::Action::follow;
  if (follows && (!limits.goes || limits.usual == 0)) return follow_at_once(actuator, *to, now);
  const bool moves = (follows || order.command->verb.action == vm::Action::move) && limits.goes;
  if (!moves || (!to && !by && !limits.sweeps)) return told(order);
  const std::int64_t from = queue.motion.at(now);
  const bool back = given(order, vm::Param::direction).value_or(1) < 0;
  const std::int64_t target = std::clamp<std::int64_t>(
      to ? *to : from + (back ? -1 : 1) * by.value_or(0), limits.least, limits.most);
  const std::int64_t least = *travel(target - from, limits.speed);
  if (limits.usual == 0) {
    if (!to && !by) return told(order);
    const bool limited = limits.speed < vm::kValueMax;
    const std::int64_t length = std::max(told(order) * 1000, limited ? least : 0);
    queue.motion = {from, target, now, length};
    return (length + 999) / 1000;
  }
  const std::int64_t speed =
      std::clamp<std::int64_t>(given(order, vm::Param::at).value_or(limits.usual), 0, limits.speed);
  if (to || by) {
    const auto length = over ? std::max(std::max<std::int64_t>(*over, 0) * 1000, least)
                             : travel(target - from, speed);
    if (!length) return 0;
    go(actuator, target, *length, now);
  } else {
    if (speed <= 0 || limits.least == limits.most) return 0;
    const std::int64_t whole = std::max<std::int64_t>(over.value_or(0), 0) * 1000;
    const std::int64_t way = 2 * (limits.most - limits.least);
    queue.speed =
        whole == 0 ? speed : std::clamp<std::int64_t>(way * 1'000'000 / whole, 1, limits.speed);
    queue.home = from;
    const std::int64_t times = given(order, vm::Param::times).value_or(1000) / 1000;
    queue.legs = 3 * static_cast<unsigned>(std::clamp<std::int64_t>(times, 1, kMostGestures));
    next_leg(actuator, now);
  }
  return (queue.motion.length + 999) / 1000;
}

// Without a speed of its own it is there at once, but for its limit.
Millis Actuators::follow_at_once(std::size_t actuator, std::int64_t to, Millis now) {
  const Limits& limits = limits_[actuator];
  Motion& motion = queues_[actuator].motion;
  if (!limits.goes || limits.speed == vm::kValueMax) {
    motion = {to, to, now, 0};
    return 0;
  }
  motion = {motion.from, to, now, *travel(to - motion.from, limits.speed)};
  return (motion.length + 999) / 1000;
}

// "A key's time counts from the beginning of its round"; AT is how fast, TIMES how often.
void Actuators::begin_motion(std::size_t actuator, const Order& order, Millis now) {
  const compiler::ir::Motion& motion = program_.motions.at(*order.command->motion);
  Queue& queue = queues_[actuator];
  const std::int64_t tempo = given(order, vm::Param::at).value_or(100'000);
  const std::int64_t times = given(order, vm::Param::times).value_or(1000) / 1000;
  if (tempo <= 0 || times < 1) return;
  const auto stretched = [&](std::int64_t time) { return time * 100'000 / tempo; };
  const Millis length = stretched(motion.length);
  for (std::int64_t round = 0; round < std::min(times, kMostGestures); ++round) {
    for (const compiler::ir::Track& track : motion.tracks)
      for (const vm::Key& key : track.keys)
        if (track.actuator == actuator)
          queue.keys.push_back({now + round * length + stretched(key.time), key.to});
    queue.motion_ends = now + (round + 1) * length;
  }
}

// How long: to the next key, 20 ms at least, and no faster than its limit; then to the motion's end.
Millis Actuators::go_to_next_key(std::size_t actuator, Millis now) {
  Queue& queue = queues_[actuator];
  const Limits& limits = limits_[actuator];
  if (queue.keys.empty()) return std::max<Millis>(queue.motion_ends - now, 0);
  const Key key = queue.keys.front();
  queue.keys.pop_front();
  const Millis over = std::max<Millis>(key.due - now, 20);
  if (!limits.goes) return over;
  const std::int64_t from = queue.motion.at(now);
  const std::int64_t least =
      limits.speed < vm::kValueMax ? *travel(key.to - from, limits.speed) : 0;
  queue.motion = {from, key.to, now, std::max(over * 1000, least)};
  return (queue.motion.length + 999) / 1000;
}

namespace {

bool follows(const Order& order) {
  return order.command->verb.action == vm::Action::follow;
}

}  // namespace

bool Actuators::submit(std::size_t actuator, Order order) {
  const Limits& limits = limits_[actuator];
  for (auto& [param, value] : order.given) {
    if (order.command->motion) break;
    if (value && param == vm::Param::to) value = std::clamp(*value, limits.least, limits.most);
    if (value && param == vm::Param::at) value = std::clamp<std::int64_t>(*value, 0, limits.speed);
  }
  Queue& queue = queues_[actuator];
  if (order.command->verb.action == vm::Action::stop) {
    if (queue.busy) trace_.actuator("cancel", actuator);
    queue.busy = false;
    queue.orders = {order};
    return true;
  }
  // "No queue": it takes the place of the FOLLOW before it.
  if (follows(order) && waiting(queue) > 0 && follows(queue.orders.back())) {
    queue.orders.back() = order;
    return true;
  }
  if (follows(order) && queue.busy && queue.orders.size() == 1 && follows(queue.orders.front())) {
    queue.busy = false;
    queue.orders = {order};
    return true;
  }
  if (waiting(queue) >= kMostWaiting) return false;
  std::size_t all = 0;
  for (const Queue& each : queues_)
    all += waiting(each);
  if (all >= kPlaces + kPlacesEach * used_.size()) return false;
  queue.orders.push_back(order);
  return true;
}

void Actuators::start(std::size_t actuator, Millis now) {
  Queue& queue = queues_[actuator];
  while (!queue.busy && !queue.halted && !queue.orders.empty()) {
    trace_.command(actuator, queue.orders.front());
    queue.busy = true;
    queue.ends = now + begin(actuator, queue.orders.front(), now);
    if (queue.ends <= now) advance(actuator, now);
  }
}

void Actuators::cancel(std::size_t actuator, Millis now) {
  Queue& queue = queues_[actuator];
  trace_.actuator("cancel", actuator);
  let_go(actuator, queue.halted ? safe_[actuator] : on_release_[actuator], now);
  queue.orders.clear();
  queue.busy = false;
}

void Actuators::halt(std::size_t actuator, Millis now) {
  let_go(actuator, safe_[actuator], now);
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
  if (next_leg(actuator, now)) {
    queue.ends = now + (queue.motion.length + 999) / 1000;
    return true;
  }
  queue.ends = now + go_to_next_key(actuator, now);
  if (queue.ends > now) return true;
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
