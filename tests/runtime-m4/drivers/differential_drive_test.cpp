// A drive of two motors: the power of each pin for each order, and for how long; what halts, limits and other programs do to it.
#include <map>
#include <optional>

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <rapidcheck.h>

#include "runtime-m4/drivers/drivers.hpp"
#include "tests/runtime-m4/drivers/drive.hpp"
#include "tests/runtime-m4/drivers/wheels.hpp"
#include "tests/runtime-m4/rig.hpp"
#include "tests/runtime-m4/robot.hpp"
#include "tests/support/golden.hpp"
#include "vm/drive.hpp"

using namespace robosync;
using drivers::Order;
using test::kOff;
using test::order;
using test::Pulses;
using vm::Action;
using vm::Param;
using vm::Value;

namespace differential_drive_test {
namespace {

constexpr Value kUnit = vm::kScale;
constexpr kernel::Time kSecond = 1'000'000;

// 40 cm/s with full power, 12 cm between the wheels, 20 cm/s without AT.
vm::DriveParameters usual() {
  return {.pins = {3, 4, 5, 6},
          .trim = {100, 100},
          .encoders = {0, 0},
          .speed = 40 * kUnit,
          .track = 12 * kUnit,
          .usual = 20 * kUnit};
}

vm::Actuator drive_at(std::uint16_t place) {
  vm::Actuator drive{};
  drive.driver = vm::DriverId::differential_drive;
  drive.pin = place;
  drive.min = -20'000 * kUnit;
  drive.max = 20'000 * kUnit;
  drive.speed_limit = vm::kValueMax;
  drive.safe = vm::Release::coast;
  return drive;
}

// The driver with the guard, without a kernel that calls it.
struct Bench {
  explicit Bench(const vm::DriveParameters& parameters = usual(), Value limit = vm::kValueMax)
      : values(vm::values_of(parameters)) {
    wiring.speed_limit = limit;
    own(std::span(&wiring, 1));
  }
  void own(std::span<const vm::Actuator> actuators, bool safety = false) {
    vm::Image image;
    image.actuators = actuators;
    image.constants = values;
    rules.priority = vm::kSafetyPriority;
    if (safety) image.behaviors = std::span(&rules, 1);
    guard.own(image);
  }

  drivers::Device device() { return {guard, wiring, state}; }
  Pulses begin(const Order& what) {
    begun = now;
    wake = driver.start(device(), what, now);
    return pulses();
  }
  Pulses begin(Action action, std::initializer_list<std::pair<Param, Value>> params = {}) {
    return begin(order(action, params));
  }
  // How long the order takes.
  kernel::Duration end() {
    while (wake != drivers::kDone) {
      REQUIRE(wake > now);
      now = wake;
      wake = driver.advance(device(), now);
    }
    return now - begun;
  }
  Pulses pulses() const { return test::pulses_of(board); }
  Value position() const { return state.motion.at(now); }

  const drivers::Driver& driver = drivers::driver(vm::DriverId::differential_drive);
  kernel::Kernel kernel;
  test::NotingBoard board;
  guard::OutputGuard guard{kernel, board};
  vm::Behavior rules{};
  vm::Actuator wiring = drive_at(0);
  drivers::ActuatorState state;
  vm::DriveValues values;
  kernel::Time now = kSecond;
  kernel::Time wake = 0, begun = 0;
};

nlohmann::json descriptor(const std::string& device) {
  return nlohmann::json::parse(testing::read_file(std::filesystem::path(ROBOSYNC_SOURCE_DIR) /
                                                  "stdlib/devices" / (device + ".json")));
}

std::string robot(const std::string& more = "") {
  return R"({"sensors": [{"name": "near", "type": "VIRTUAL", "channels": {"X": {"range": [0, 100]}}}],
             "actuators": [{"name": "base", "type": "PWM", "device": "differential_drive", "left": [3, 4],
                            "right": [5, 6], "speed": "40cm/s", "track": "12cm")" +
         more + "}]}";
}

// A program that does `body` at 20 ms.
struct Program {
  explicit Program(const std::string& body, const std::string& more = "") {
    test::do_at_20_ms(rig, body, robot(more));
  }
  Pulses at(unsigned milliseconds) { return test::pulses_at(rig, milliseconds); }
  test::Rig rig;
};

}  // namespace

TEST_CASE("differential_drive: its verbs, words, units and model are those of the virtual drive") {
  for (const char* key : {"verbs", "words", "to", "at", "model", "safe", "on_release"})
    CHECK(descriptor("differential_drive").at(key) == descriptor("drive").at(key));
}

TEST_CASE("differential_drive: a way takes its time at AT, the usual speed, or in OVER") {
  Bench bench;
  CHECK(bench.begin(Action::move, {{Param::by, 20 * kUnit}, {Param::at, 10 * kUnit}}) ==
        Pulses{5000, 0, 5000, 0});
  CHECK(bench.end() == 2 * kSecond);
  CHECK(bench.pulses() == kOff);
  CHECK(bench.position() == 20 * kUnit);
  CHECK(bench.begin(Action::move, {{Param::by, 30 * kUnit}, {Param::direction, -kUnit}}) ==
        Pulses{0, 10'000, 0, 10'000});
  CHECK(bench.end() == 3 * kSecond / 2);
  CHECK(bench.position() == -10 * kUnit);
  CHECK(bench.begin(Action::move, {{Param::by, -4 * kUnit}}) == Pulses{0, 10'000, 0, 10'000});
  CHECK(bench.end() == kSecond / 5);
  CHECK(bench.begin(Action::move, {{Param::by, 15 * kUnit}, {Param::over, 3 * kUnit}}) ==
        Pulses{2500, 0, 2500, 0});
  CHECK(bench.end() == 3 * kSecond);
  CHECK(bench.begin(Action::move, {{Param::to, 0}}) == Pulses{0, 10'000, 0, 10'000});  // from 1 cm
  CHECK(bench.end() == kSecond / 20);
  CHECK(bench.position() == 0);
  CHECK(bench.begin(Action::move, {{Param::to, 0}}) == kOff);
  CHECK(bench.end() == 0);
}

TEST_CASE("differential_drive: without a way it drives for a time") {
  Bench bench;
  CHECK(bench.begin(Action::move) == Pulses{10'000, 0, 10'000, 0});
  CHECK(bench.end() == kSecond);
  CHECK(bench.position() == 20 * kUnit);
  bench.begin(Action::move, {{Param::direction, -kUnit}, {Param::over, 500}});
  CHECK(bench.end() == kSecond / 2);
  CHECK(bench.position() == 10 * kUnit);
  bench.begin(Action::move, {{Param::times, 3 * kUnit}});
  CHECK(bench.end() == 3 * kSecond);
}

TEST_CASE("differential_drive: a turn goes along arcs, to the right with the left wheel forward") {
  Bench bench;
  CHECK(bench.begin(Action::play, {{Param::by, 90 * kUnit}, {Param::direction, -kUnit}}) ==
        Pulses{0, 10'000, 10'000, 0});
  CHECK(bench.end() == 471'200);  // pi * 12 cm / 4 = 9.4248 cm, at 20 cm/s
  CHECK(bench.begin(Action::play, {{Param::by, 90 * kUnit}, {Param::direction, kUnit}}) ==
        Pulses{10'000, 0, 0, 10'000});
  CHECK(bench.end() == 471'200);
  CHECK(bench.begin(Action::play, {{Param::by, 180 * kUnit}, {Param::over, 2 * kUnit}}) ==
        Pulses{4712, 0, 0, 4712});  // 18.85 cm in 2 s
  CHECK(bench.end() == 2 * kSecond);
  CHECK(bench.begin(Action::play, {{Param::at, 30 * kUnit}, {Param::for_, 700}}) ==
        Pulses{15'000, 0, 0, 15'000});
  CHECK(bench.end() == 700'000);
  CHECK(bench.begin(Action::play, {{Param::direction, -kUnit}}) == Pulses{0, 10'000, 10'000, 0});
  CHECK(bench.end() == kSecond);
  bench.begin(Action::play, {{Param::times, 2 * kUnit}});  // 75.398 cm
  CHECK(bench.end() == 3'769'900);
  CHECK(bench.position() == 0);
}

TEST_CASE("differential_drive: the largest turn on the largest track is bounded, not overflown") {
  vm::DriveParameters parameters = usual();
  parameters.track = vm::kMostTrack;
  Bench bench(parameters);
  constexpr kernel::Duration kLongest = std::uint64_t{INT32_MAX} * 1'000'000 / (20 * kUnit);
  CHECK(bench.begin(Action::play, {{Param::times, vm::kValueMax}}) == Pulses{10'000, 0, 0, 10'000});
  CHECK(bench.end() == kLongest);
  CHECK(bench.begin(Action::play, {{Param::by, -vm::kValueMax}}) == Pulses{0, 10'000, 10'000, 0});
  CHECK(bench.end() == kLongest);
}

TEST_CASE("differential_drive: nothing exceeds the speed of full power, or the limit") {
  Bench full;
  CHECK(full.begin(Action::move, {{Param::by, 80 * kUnit}, {Param::at, 99 * kUnit}}) ==
        Pulses{20'000, 0, 20'000, 0});
  CHECK(full.end() == 2 * kSecond);
  CHECK(full.begin(Action::move, {{Param::by, 80 * kUnit}, {Param::over, 100}}) ==
        Pulses{20'000, 0, 20'000, 0});
  CHECK(full.end() == 2 * kSecond);
  Bench limited(usual(), 10 * kUnit);
  CHECK(limited.begin(Action::move, {{Param::by, 10 * kUnit}}) == Pulses{5000, 0, 5000, 0});
  CHECK(limited.end() == kSecond);
  CHECK(limited.begin(Action::play, {{Param::by, 90 * kUnit}, {Param::over, 1}}) ==
        Pulses{5000, 0, 0, 5000});
  CHECK(limited.end() == 942'400);
  CHECK(full.begin(Action::move, {{Param::by, 80 * kUnit}, {Param::at, 0}}) == kOff);
  CHECK(full.end() == 0);
}

TEST_CASE("differential_drive: a trim takes power from one motor") {
  vm::DriveParameters parameters = usual();
  parameters.trim = {95, 100};
  Bench left(parameters);
  CHECK(left.begin(Action::move, {{Param::at, 40 * kUnit}}) == Pulses{19'000, 0, 20'000, 0});
  parameters.trim = {100, 80};
  Bench right(parameters);
  CHECK(right.begin(Action::play, {{Param::at, 40 * kUnit}}) == Pulses{20'000, 0, 0, 16'000});
}

TEST_CASE("differential_drive: STOP and each release end it where it is") {
  for (const auto how : {vm::Release::hold, vm::Release::rest, vm::Release::coast}) {
    Bench bench;
    bench.begin(Action::move, {{Param::by, 20 * kUnit}, {Param::at, 10 * kUnit}});
    bench.now += kSecond;
    bench.driver.release(bench.device(), how, bench.now);
    CHECK(bench.pulses() == kOff);
    bench.now += kSecond;
    CHECK(bench.position() == 10 * kUnit);
  }
  Bench bench;
  bench.begin(Action::move, {{Param::by, 20 * kUnit}, {Param::at, 10 * kUnit}});
  bench.now += kSecond / 2;
  CHECK(bench.begin(Action::stop) == kOff);
  CHECK(bench.end() == 0);
  CHECK(bench.position() == 5 * kUnit);
}

TEST_CASE("differential_drive: a way beyond the range is driven, and is not counted") {
  Bench bench;
  bench.begin(Action::move, {{Param::to, 20'000 * kUnit}});
  bench.end();
  CHECK(bench.begin(Action::move, {{Param::by, 20 * kUnit}}) == Pulses{10'000, 0, 10'000, 0});
  CHECK(bench.end() == kSecond);
  CHECK(bench.position() == 20'000 * kUnit);
}

TEST_CASE("differential_drive: whatever is ordered ends, inside the frame, never on both pins") {
  const bool holds = rc::check("differential_drive", [] {
    vm::DriveParameters parameters = usual();
    parameters.speed = *rc::gen::inRange<Value>(1, vm::kValueMax);
    parameters.track = *rc::gen::inRange<Value>(1, vm::kMostTrack + 1);
    parameters.usual = *rc::gen::inRange<Value>(1, vm::kValueMax);
    Bench bench(parameters, *rc::gen::inRange<Value>(0, vm::kValueMax));
    for (unsigned left = *rc::gen::inRange(1U, 5U); left > 0; --left) {
      Order what = order(*rc::gen::element(Action::move, Action::play, Action::stop));
      what.given = *rc::gen::arbitrary<std::uint8_t>();
      for (Value& value : what.params)
        value = *rc::gen::oneOf(rc::gen::inRange<Value>(-1000, 1000),
                                rc::gen::inRange<Value>(-vm::kValueMax, vm::kValueMax));
      Value& at = what.params[static_cast<std::size_t>(Param::at)];
      at = std::abs(at);
      bench.begin(what);
      bench.end();
      RC_ASSERT(bench.pulses() == kOff);
    }
    std::map<std::uint16_t, std::uint32_t> on;
    for (const auto& [pin, pulse] : bench.board.writes) {
      on[pin] = pulse;
      RC_ASSERT(pulse <= 20'000U);
      RC_ASSERT(on[3] == 0U || on[4] == 0U);
      RC_ASSERT(on[5] == 0U || on[6] == 0U);
    }
  });
  CHECK(holds);
}

TEST_CASE("differential_drive: a halt switches all four pins off, and no order reaches them") {
  for (const bool turns : {false, true}) {
    Bench bench;
    const Order what = order(turns ? Action::play : Action::move);
    bench.begin(what);
    bench.guard.halt(1);
    CHECK(bench.pulses() == kOff);
    CHECK(bench.begin(what) == kOff);
    bench.guard.let_go(1);
    CHECK(bench.pulses() == kOff);
    CHECK(bench.begin(what) != kOff);
    bench.guard.halt(~std::uint32_t{0});
    CHECK(bench.pulses() == kOff);
  }
}

TEST_CASE("differential_drive: an actuator that is no drive moves no wheels") {
  Bench bench;
  vm::Actuator motor = vm::motor_of(bench.wiring, usual(), vm::Side::left);
  bench.own(std::span(&motor, 1));
  bench.guard.drive_wheels(0, 5000, 5000, bench.now);
  bench.guard.drive_wheels(1, 5000, 5000, bench.now);
  CHECK(bench.pulses() == kOff);
  CHECK(bench.begin(Action::move) == kOff);
  CHECK(bench.end() == 0);
}

TEST_CASE("differential_drive: without one of its pins it drives none of them") {
  constexpr policy::PinLimit kLimits[] = {
      {.first = 3, .last = 5, .shortest = 0, .longest = 20'000, .rise = 0}};
  Bench bench;
  bench.board.board_pins = {
      .outputs = kLimits, .inputs = {}, .analog = {}, .enables = {}, .i2c_buses = 1};
  bench.own(std::span(&bench.wiring, 1));
  CHECK(bench.begin(Action::move) == kOff);
  CHECK(bench.end() == 0);
}

TEST_CASE("differential_drive: each of its pins keeps its own limits") {
  constexpr policy::PinLimit kLimits[] = {
      {.first = 3, .last = 5, .shortest = 0, .longest = 20'000, .rise = 0},
      {.first = 6, .last = 6, .shortest = 0, .longest = 10'000, .rise = 50}};
  Bench bench;
  bench.board.board_pins = {
      .outputs = kLimits, .inputs = {}, .analog = {}, .enables = {}, .i2c_buses = 1};
  bench.own(std::span(&bench.wiring, 1));
  bench.guard.drive_wheels(0, 15'000, -15'000, bench.now);
  const auto later = [&](unsigned milliseconds) {
    bench.now += kernel::milliseconds(milliseconds);
    bench.guard.go_on(bench.now);
    return bench.pulses();
  };
  CHECK(later(10) == Pulses{15'000, 0, 0, 500});
  CHECK(later(20) == Pulses{15'000, 0, 0, 1500});
  for (unsigned i = 0; i < 20; ++i)
    later(20);
  CHECK(later(20) == Pulses{15'000, 0, 0, 10'000});
  bench.guard.drive_wheels(0, 15'000, 15'000, bench.now);
  CHECK(bench.pulses() == Pulses{15'000, 0, 15'000, 0});
  bench.guard.drive_wheels(0, 0, -15'000, bench.now);
  later(20);
  bench.guard.halt(1);
  CHECK(bench.pulses() == kOff);
  CHECK(later(20) == kOff);
}

TEST_CASE("differential_drive: it goes off if the next program drives its pins in another way") {
  const auto after = [](auto change, bool safety) {
    Bench bench;
    bench.begin(Action::play);
    std::array<vm::Actuator, 1> next{bench.wiring};
    vm::DriveParameters parameters = usual();
    change(next[0], parameters);
    bench.values = vm::values_of(parameters);
    bench.own(next, safety);
    return bench.pulses();
  };
  const auto same = [](auto&, auto&) {};
  CHECK(after(same, false) == Pulses{10'000, 0, 0, 10'000});
  CHECK(after(same, true) == kOff);
  CHECK(after(
            [](auto&, auto& drive) {
              drive.pins = {3, 4, 6, 5};
            },
            false) == Pulses{10'000, 0, 0, 0});
  CHECK(after(
            [](auto&, auto& drive) {
              drive.pins = {4, 3, 5, 6};
            },
            false) == Pulses{0, 0, 0, 10'000});
  CHECK(after([](auto& next, auto&) { next.driver = vm::DriverId::virtual_actuator; }, false) ==
        kOff);
  const auto left_only = [](auto& next, auto& drive) {
    next = vm::motor_of(next, drive, vm::Side::left);
  };
  CHECK(after(left_only, false) == Pulses{10'000, 0, 0, 0});
  Bench bench;
  bench.begin(Action::play);
  bench.guard.disown();
  CHECK(bench.pulses() == kOff);
}

TEST_CASE("differential_drive: a board that cannot drive one of the pins refuses the program") {
  constexpr policy::PinLimit kLimits[] = {
      {.first = 3, .last = 5, .shortest = 0, .longest = 20'000, .rise = 0},
      {.first = 6, .last = 6, .shortest = 1000, .longest = 2000, .rise = 0},
      {.first = 7, .last = 8, .shortest = 0, .longest = 20'000, .rise = 0}};
  const policy::BoardPins pins = {
      .outputs = kLimits, .inputs = {}, .analog = {}, .enables = {}, .i2c_buses = 1};
  const auto refusal = [&](std::array<std::uint8_t, 4> used) {
    vm::DriveParameters parameters = usual();
    parameters.pins = used;
    const vm::DriveValues values = vm::values_of(parameters);
    const vm::Actuator drive = drive_at(0);
    vm::Image image;
    image.actuators = std::span(&drive, 1);
    image.constants = values;
    return policy::judge(image, pins).refusal;
  };
  CHECK(refusal({3, 4, 5, 7}) == vm::Refusal::none);
  CHECK(refusal({3, 4, 5, 6}) == vm::Refusal::no_pin);  // pulses of servos only
  CHECK(refusal({9, 4, 5, 7}) == vm::Refusal::no_pin);
  CHECK(refusal({3, 9, 5, 7}) == vm::Refusal::no_pin);
  CHECK(refusal({3, 4, 9, 7}) == vm::Refusal::no_pin);
}

TEST_CASE("differential_drive: commands follow each other, and SAFETY ends all of them") {
  Program program("DRIVE base FORWARD 20cm AT 10cm/s\nTHEN\nTURN base LEFT 90deg");
  CHECK(program.at(1000) == Pulses{5000, 0, 5000, 0});
  CHECK(program.at(2019) == Pulses{5000, 0, 5000, 0});
  CHECK(program.at(2030) == Pulses{0, 10'000, 10'000, 0});
  CHECK(program.at(2480) == Pulses{0, 10'000, 10'000, 0});
  CHECK(program.at(2500) == kOff);

  Program halted("DRIVE base FORWARD 20cm AT 10cm/s\nTHEN\nTURN base LEFT 90deg");
  CHECK(halted.at(1000) == Pulses{5000, 0, 5000, 0});
  halted.rig.feed(0, 95, 1000);
  CHECK(halted.at(1001) == kOff);
  CHECK(halted.at(4000) == kOff);
}

TEST_CASE("differential_drive: robot.json gives its measures, its trim and its limit") {
  Program trimmed("DRIVE base FORWARD 20cm AT 20cm/s", R"(, "trim": {"right": "90%"})");
  CHECK(trimmed.at(500) == Pulses{10'000, 0, 9000, 0});
  Program limited("DRIVE base FORWARD 20cm", R"(, "limits": {"SPEED": "4cm/s"})");
  CHECK(limited.at(5000) == Pulses{2000, 0, 2000, 0});
  CHECK(limited.at(5030) == kOff);
}

}  // namespace differential_drive_test
