// The output guard alone, and in the whole runtime: random sequences of anything that can happen, checked against its
// guarantees. The board records every pulse, so that even a momentary error is not missed.
#include <algorithm>
#include <array>
#include <map>
#include <optional>

#include <catch2/catch.hpp>

#include "runtime-m4/guard/output_guard.hpp"
#include "tests/runtime-m4/layers/draw.hpp"
#include "tests/runtime-m4/rig.hpp"
#include "tests/runtime-m4/robot.hpp"
#include "tests/vm/image_builder.hpp"

using namespace robosync;

namespace {

constexpr policy::PinLimit kLimits[] = {
    {.first = 0, .last = 3, .shortest = 0, .longest = 20'000, .rise = 0},
    {.first = 4, .last = 5, .shortest = 1'000, .longest = 2'000, .rise = 2},
    {.first = 6, .last = 6, .shortest = 0, .longest = 10'000, .rise = 50}};
constexpr policy::BoardPins kPins = {
    .outputs = kLimits, .inputs = {}, .analog = {}, .enables = {}, .i2c_buses = 1};
constexpr std::uint16_t kOutputs = 7;
constexpr unsigned kLongestStep = 20;  // most ms that one change may cover

bool is_allowed(std::uint16_t pin, std::uint32_t pulse) {
  const policy::PinLimit* const limit = policy::limit_of(kPins, pin);
  return pulse == 0 || (limit != nullptr && pulse >= limit->shortest && pulse <= limit->longest);
}

// May the pulse of the pin have changed from `before` to `after` in `passed` milliseconds?
bool is_slow_enough(std::uint16_t pin, std::uint32_t before, std::uint32_t after, unsigned passed) {
  const policy::PinLimit& limit = *policy::limit_of(kPins, pin);
  if (limit.rise == 0 || after == 0 || after == before) return true;
  const bool pulses = limit.shortest != 0;
  if (pulses ? before == 0 : after < before) return true;
  const std::uint32_t way = after > before ? after - before : before - after;
  return way <= limit.rise * std::min(passed, kLongestStep);
}

vm::Actuator on_pin(std::uint16_t pin, vm::DriverId driver = vm::DriverId::servo) {
  vm::Actuator actuator{};
  actuator.driver = driver;
  actuator.pin = pin;
  actuator.max = 180 * vm::kScale;
  return actuator;
}

vm::Actuator drawn(std::uint16_t pin, test::Draw& draw) {
  constexpr vm::Release kSafe[] = {vm::Release::hold, vm::Release::rest, vm::Release::coast};
  vm::Actuator actuator = on_pin(pin, draw.one_in(2) ? vm::DriverId::servo : vm::DriverId::pwm);
  actuator.safe = kSafe[draw.below(3)];
  return actuator;
}

vm::Actuator motor(std::uint16_t forward, std::uint8_t back) {
  vm::Actuator actuator = on_pin(forward, vm::DriverId::motor);
  actuator.bus = back;
  actuator.min = -actuator.max;
  return actuator;
}

bool may_drive(const vm::Actuator& actuator) {
  return policy::can_drive(actuator, kPins);
}

// Actuators on some of the pins, two of which are not outputs. No pin has two actuators.
std::vector<vm::Actuator> drawn_robot(test::Draw& draw) {
  constexpr std::uint16_t kPinsAndMore = 9;
  std::vector<vm::Actuator> robot;
  std::array<bool, kPinsAndMore> taken{};
  for (std::uint16_t pin = 0; pin < kPinsAndMore; ++pin) {
    if (taken[pin] || draw.one_in(2)) continue;
    taken[pin] = true;
    const auto second = static_cast<std::uint8_t>(draw.below(kPinsAndMore));
    const bool two = draw.one_in(3) && !taken[second];
    robot.push_back(two ? motor(pin, second) : drawn(pin, draw));
    if (two) taken[second] = true;
  }
  return robot;
}

// Is `after` a correct pulse after halting the actuator at the pulse `before`? A servo rests at the shortest pulse, and may need
// time to get there.
bool is_safe(const vm::Actuator& actuator, std::uint32_t before, std::uint32_t after) {
  if (vm::gives_power(actuator.driver) || actuator.safe == vm::Release::coast) return after == 0;
  if (actuator.safe == vm::Release::hold || before == 0) return after == before;
  const policy::PinLimit& limit = *policy::limit_of(kPins, actuator.pin);
  return limit.rise != 0 ? after <= before : after == std::max<std::uint32_t>(500, limit.shortest);
}

// A guard on a board with kPins, its programs, and the pulses seen on the pins so far.
struct Bench {
  Bench() { board.board_pins = kPins; }

  void own(std::vector<vm::Actuator> next, std::uint32_t halted = 0, bool has_safety = false) {
    actuators = std::move(next);
    vm::Image image;
    image.actuators = actuators;
    safety.priority = vm::kSafetyPriority;
    if (has_safety) image.behaviors = std::span(&safety, 1);
    guard.begin_with(halted);
    guard.own(image);
  }
  std::uint32_t pulse(std::uint16_t pin) const { return board.pwm_read(pin); }

  kernel::Kernel kernel;
  test::NotingBoard board;
  guard::OutputGuard guard{kernel, board};
  std::vector<vm::Actuator> actuators;
  vm::Behavior safety{};
};

}  // namespace

TEST_CASE("a pin is driven only for an actuator of the program") {
  Bench bench;
  bench.guard.drive(0, 1500, 0);
  CHECK(bench.board.pulses.empty());
  bench.own({on_pin(3)});
  bench.guard.drive(0, 1500, 0);
  CHECK(bench.pulse(3) == 1500);
  bench.guard.drive(1, 1500, 0);
  CHECK(bench.board.pulses.size() == 1);
  bench.guard.disown();
  CHECK(bench.pulse(3) == 0);
  bench.guard.drive(0, 1500, 0);
  CHECK(bench.pulse(3) == 0);
}

TEST_CASE("a safe state beside the range of its pin ends where the range does") {
  Bench bench;
  vm::Actuator resting = on_pin(4);
  resting.safe = vm::Release::rest;  // 500 us, according to the image
  bench.own({resting});
  bench.guard.drive(0, 1'010, 0);
  bench.guard.halt(1);
  for (unsigned ms = 20; ms < 1000; ms += 20)
    bench.guard.go_on(kernel::milliseconds(ms));
  CHECK(bench.pulse(4) == 1'000);
}

TEST_CASE("what the next program drives in the same way stays as it is, all else goes off") {
  Bench bench;
  bench.own({on_pin(0), on_pin(1), on_pin(2)});
  for (unsigned a = 0; a < 3; ++a)
    bench.guard.drive(a, 1500, 0);
  bench.own({on_pin(2), on_pin(1, vm::DriverId::pwm)});
  CHECK(bench.pulse(0) == 0);
  CHECK(bench.pulse(1) == 0);  // pulses for a servo are power for a motor
  CHECK(bench.pulse(2) == 1500);
}

TEST_CASE("power goes off when the next program has SAFETY rules, and a servo's pulses stay") {
  for (const bool has_safety : {false, true}) {
    CAPTURE(has_safety);
    Bench bench;
    const std::vector<vm::Actuator> robot{on_pin(0), on_pin(1, vm::DriverId::pwm), motor(2, 3)};
    bench.own(robot);
    bench.guard.drive(0, 1'000, 0);
    bench.guard.drive(1, 5'000, 0);
    bench.guard.drive_either(2, -6'000, 0);
    bench.own(robot, 0, has_safety);
    CHECK(bench.pulse(0) == 1'000);
    CHECK(bench.pulse(1) == (has_safety ? 0 : 5'000));
    CHECK(bench.pulse(2) == 0);
    CHECK(bench.pulse(3) == (has_safety ? 0 : 6'000));
  }
}

TEST_CASE("an actuator that is halted takes no order until it is let go") {
  Bench bench;
  bench.own({on_pin(0), on_pin(1)});
  bench.guard.drive(0, 1500, 0);
  bench.guard.halt(0b01);
  bench.guard.drive(0, 600, 0);
  bench.guard.drive(1, 600, 0);
  CHECK(bench.pulse(0) == 1500);
  CHECK(bench.pulse(1) == 600);
  bench.guard.let_go(0b01);
  bench.guard.drive(0, 700, 0);
  CHECK(bench.pulse(0) == 700);
}

TEST_CASE("an actuator that is halted is in its safe state at once, without its driver") {
  constexpr std::uint32_t kAtRest = 500;  // of a range that begins with 0
  vm::Actuator rests = on_pin(0);
  rests.safe = vm::Release::rest;
  vm::Actuator coasts = on_pin(1);
  coasts.safe = vm::Release::coast;
  vm::Actuator begins_elsewhere = on_pin(2);
  begins_elsewhere.min = -90 * vm::kScale;
  begins_elsewhere.max = 90 * vm::kScale;
  begins_elsewhere.safe = vm::Release::rest;
  Bench bench;
  bench.own({rests, coasts, begins_elsewhere, on_pin(3, vm::DriverId::pwm)});
  for (unsigned a = 0; a < 4; ++a)
    bench.guard.drive(a, 1800, 0);
  bench.guard.halt(0b1111);
  CHECK(bench.pulse(0) == kAtRest);
  CHECK(bench.pulse(1) == 0);
  CHECK(bench.pulse(2) == 1500);
  CHECK(bench.pulse(3) == 0);  // a motor, whatever its image says
}

TEST_CASE("nothing begins to move because it is halted") {
  vm::Actuator rests = on_pin(0);
  rests.safe = vm::Release::rest;
  Bench bench;
  bench.own({rests});
  bench.guard.halt(0b1);
  CHECK(bench.pulse(0) == 0);  // it was never driven
  bench.guard.let_go(0b1);
  bench.guard.drive(0, 1800, 0);
  bench.own({rests},
            0b1);  // a program that comes while everything is stopped has its own safe state
  CHECK(bench.pulse(0) == 500);
  bench.guard.drive(0, 600, 0);
  CHECK(bench.pulse(0) == 500);
}

TEST_CASE("what is on its way stays where it is when it is halted") {
  Bench bench;
  bench.own({on_pin(4)});
  bench.guard.drive(0, 1'000, 0);
  bench.guard.drive(0, 1'100, 1'000'000);
  bench.kernel.machine().run_until(1'000'000);
  bench.guard.halt(0b1);
  bench.guard.go_on(2'000'000);
  CHECK(bench.pulse(4) == 1'040);
}

TEST_CASE("pulses stay inside the range of their pin, and off is always allowed") {
  Bench bench;
  bench.own({on_pin(4), on_pin(6, vm::DriverId::pwm)});
  bench.guard.drive(0, 2'500, 0);
  CHECK(bench.pulse(4) == 2'000);
  bench.guard.drive(0, 0, 0);
  CHECK(bench.pulse(4) == 0);
  bench.guard.drive(0, 500, 1'000'000);
  CHECK(bench.pulse(4) == 1'000);
  bench.guard.drive(1, UINT32_MAX, 1'000'000);
  CHECK(bench.pulse(6) <= 10'000);
}

TEST_CASE("a pulse that may not change at once goes on by itself, up to where it was told to go") {
  Bench bench;
  bench.own({on_pin(4)});
  bench.guard.drive(0, 1'000, 0);
  kernel::Time now = 1'000'000;
  bench.guard.drive(0, 1'100, now);
  CHECK(bench.pulse(4) == 1'040);
  for (const unsigned expected : {1'060U, 1'080U, 1'100U, 1'100U}) {
    now += 10'000;
    bench.guard.go_on(now);
    CHECK(bench.pulse(4) == expected);
  }
}

TEST_CASE("a motor that turns round is off for a moment: its pins are never both on") {
  Bench bench;
  bench.own({motor(1, 2)});
  bench.guard.drive_either(0, 5'000, 0);
  bench.guard.drive_either(0, -7'000, 0);
  bench.guard.drive_either(0, 0, 0);
  bench.guard.drive_either(0, -1, 0);
  bench.guard.drive_either(0, INT32_MIN, 0);
  using Writes = std::vector<std::pair<std::uint16_t, std::uint32_t>>;
  CHECK(bench.board.writes == Writes{{1, 5'000}, {1, 0}, {2, 7'000}, {2, 0}, {2, 1}, {2, 20'000}});
}

TEST_CASE("a motor that is halted is off, whichever way it runs, and takes no order") {
  for (const int way : {5'000, -5'000}) {
    Bench bench;
    bench.own({motor(1, 2)});
    bench.guard.drive_either(0, way, 0);
    bench.guard.halt(1);
    CHECK((bench.pulse(1) | bench.pulse(2)) == 0);
    bench.guard.drive_either(0, way, 0);
    bench.guard.drive_either(0, -way, 0);
    CHECK((bench.pulse(1) | bench.pulse(2)) == 0);
  }
}

TEST_CASE("each pin of a motor keeps its own limits") {
  Bench bench;
  bench.own({motor(1, 6)});  // 6: half of the power, and 50 us in a millisecond
  bench.guard.drive_either(0, 20'000, 0);
  CHECK(bench.pulse(1) == 20'000);
  bench.guard.drive_either(0, -20'000, 1'000'000);
  CHECK(bench.pulse(1) == 0);
  CHECK(bench.pulse(6) == 0);
  bench.guard.go_on(1'010'000);
  CHECK(bench.pulse(6) == 500);
  for (unsigned ms = 1'020; ms < 2'000; ms += 10)
    bench.guard.go_on(kernel::milliseconds(ms));
  CHECK(bench.pulse(6) == 10'000);
  bench.guard.drive_either(0, 3'000, 2'000'000);
  CHECK(bench.pulse(1) == 3'000);  // immediately, as its pin allows
  bench.guard.go_on(2'010'000);
  CHECK(bench.pulse(6) == 0);
}

TEST_CASE("a motor that runs backward runs on in a program that has it, and in no other") {
  const auto after = [](const std::vector<vm::Actuator>& next) {
    Bench bench;
    bench.own({motor(1, 2)});
    bench.guard.drive_either(0, -7'000, 0);
    bench.own(next);
    return bench.pulse(2);
  };
  CHECK(after({motor(1, 2)}) == 7'000);
  CHECK(after({motor(2, 1)}) == 0);
  CHECK(after({motor(1, 3)}) == 0);
  CHECK(after({motor(3, 2)}) == 0);
  CHECK(after({on_pin(2, vm::DriverId::pwm)}) == 0);
  CHECK(after({}) == 0);
  Bench bench;
  bench.own({motor(1, 2)});
  bench.guard.drive_either(0, -7'000, 0);
  bench.own({motor(1, 2)});
  bench.guard.drive_either(0, 7'000, 0);  // its direction is known
  CHECK(bench.pulse(2) == 0);
  CHECK(bench.pulse(1) == 7'000);
}

TEST_CASE("what has one pin has no other way; and a pin that is a servo's drives no motor") {
  Bench bench;
  bench.own({on_pin(1, vm::DriverId::pwm), motor(2, 4), motor(5, 3), on_pin(4, vm::DriverId::pwm)});
  bench.guard.drive_either(0, 5'000, 0);
  CHECK(bench.pulse(1) == 5'000);
  bench.guard.drive_either(0, -5'000, 0);
  CHECK(bench.pulse(1) == 0);
  for (unsigned a = 1; a < 4; ++a) {
    bench.guard.drive_either(a, 5'000, 0);
    bench.guard.drive_either(a, -5'000, 0);
    bench.guard.drive(a, 5'000, 0);
  }
  for (std::uint16_t pin = 2; pin < 6; ++pin)
    CHECK(bench.pulse(pin) == 0);
}

// Random actuators on random pins, and random calls of drivers without any limits.
TEST_CASE(
    "how fast a pulse may change is a matter of the pin, whatever the program before had there") {
  Bench bench;
  bench.own({on_pin(4)});
  bench.own({on_pin(2)});
  bench.guard.drive(0, 1000, 0);
  bench.guard.drive(0, 1500, 0);
  CHECK(bench.pulse(2) == 1500);
}

TEST_CASE("no sequence widens a limit, nor drives a pin that no running program owns") {
  test::Draw draw(13);
  for (unsigned round = 0; round < 300; ++round) {
    std::optional<Bench> bench(std::in_place);
    kernel::Time now = 1'000'000;
    std::uint32_t halted = 0;
    std::array<kernel::Time, kOutputs> changed{};
    for (unsigned event = 0; event < 60; ++event) {
      now += draw.below(30) * 1'000U;
      std::array<std::uint32_t, kOutputs> before{};
      for (std::uint16_t pin = 0; pin < kOutputs; ++pin)
        before[pin] = bench->pulse(pin);
      std::map<std::uint16_t, std::uint32_t> before_each;
      for (std::uint16_t pin = 0; pin < kOutputs; ++pin)
        before_each[pin] = before[pin];
      bench->board.pulses.clear();
      bench->board.writes.clear();
      for (std::uint16_t pin = 0; pin < kOutputs; ++pin)
        if (before[pin] != 0) bench->board.pulses[pin] = {before[pin]};
      const unsigned actuator = draw.below(8);
      bool held = true;         // halted actuators must not have moved
      bool begins = false;      // a new program, which may begin with one step
      std::uint32_t fresh = 0;  // … except those halted just now
      switch (draw.below(10)) {
        case 0: {
          bench->own(drawn_robot(draw));
          halted = 0;
          begins = true;
          held = false;
          break;
        }
        case 1:
          bench->guard.disown();
          bench->actuators.clear();
          held = false;
          break;
        case 2:
          fresh = 1U << actuator & ~halted;
          halted |= 1U << actuator;
          bench->kernel.machine().run_until(now);
          bench->guard.halt(1U << actuator);
          break;
        case 3:
          halted &= ~(1U << actuator);
          bench->guard.let_go(1U << actuator);
          break;
        case 4:
          bench->guard.go_on(now);
          held = false;
          break;
        case 5:
          if (draw.one_in(4)) {  // a reset: the pins go off, and the past is forgotten
            bench.emplace();
            before = {};
            halted = 0;
          }
          break;
        default: {
          const std::uint32_t pulse = draw.one_in(3) ? draw.below(UINT32_MAX) : draw.below(25'000);
          const auto either = static_cast<std::int32_t>(pulse);
          if (draw.one_in(2))
            bench->guard.drive(actuator, pulse, now);
          else
            bench->guard.drive_either(actuator, draw.one_in(2) ? either : -either, now);
        }
      }
      for (const auto& [pin, pulse] : bench->board.writes) {
        before_each[pin] = pulse;
        for (const vm::Actuator& owner : bench->actuators)
          if (vm::has_two_pins(owner.driver) && may_drive(owner) && !begins)
            REQUIRE((before_each[owner.pin] == 0 || before_each[owner.bus] == 0));
      }
      for (const auto& [pin, pulses] : bench->board.pulses) {
        REQUIRE(pin < kOutputs);
        for (const std::uint32_t pulse : pulses)
          REQUIRE(is_allowed(pin, pulse));
        const std::uint32_t after = pulses.back();
        REQUIRE(is_slow_enough(pin, before[pin], after,
                               static_cast<unsigned>((now - changed[pin]) / 1000)));
        if (after != before[pin]) changed[pin] = now;
        const auto owner = std::ranges::find_if(
            bench->actuators,
            [pin = pin](const vm::Actuator& one) { return test::has_pin(one, pin); });
        if (owner == bench->actuators.end() || !may_drive(*owner)) {
          REQUIRE(after == 0);
        } else if (const auto a = owner - bench->actuators.begin(); (fresh >> a & 1) != 0) {
          REQUIRE(is_safe(*owner, before[pin], after));
        } else if (held && (halted >> a & 1) != 0) {
          REQUIRE(after == before[pin]);
        }
      }
      if (begins) changed.fill(0);
    }
  }
}
