// Drivers on a board that records what they do; from raw counts to values; from commands to orders.
#include "runtime-m4/drivers/drivers.hpp"

#include <catch2/catch.hpp>
#include <rapidcheck.h>

#include "runtime-m4/layers/sampler.hpp"
#include "tests/runtime-m4/drivers/drive.hpp"
#include "tests/runtime-m4/rig.hpp"

using namespace robosync;
using drivers::ActuatorState;
using drivers::Device;
using drivers::Order;
using test::Drive;
using test::order;
using vm::Param;
using vm::Value;

namespace {

constexpr Value kDeg = vm::kScale;

std::vector<std::byte> bytes(std::initializer_list<int> values) {
  std::vector<std::byte> result;
  for (const int value : values)
    result.push_back(static_cast<std::byte>(value));
  return result;
}

// A sensor with a channel, on a bus whose answers the test gives.
struct OnBus {
  OnBus(vm::DriverId id, std::uint16_t address, std::uint8_t input) : driver(drivers::driver(id)) {
    sensor.bus = 1;
    sensor.address = address;
    channel.input = input;
  }
  bool read(std::initializer_list<int> answers) {
    const std::vector<std::byte> given = bytes(answers);
    board.answers.assign(given.begin(), given.end());
    return driver.read(board, sensor, channel, raw);
  }

  const drivers::Driver& driver;
  test::NotingBoard board;
  vm::Sensor sensor{};
  vm::Channel channel{};
  std::int32_t raw = 99;
};

}  // namespace

TEST_CASE("max34451: the page is the input, the count is READ_VOUT") {
  OnBus chip(vm::DriverId::max34451, 0x70, 5);
  REQUIRE(chip.read({0x34, 0xF2}));
  CHECK(chip.raw == 0xF234);
  const auto& transfers = chip.board.transfers;
  REQUIRE(transfers.size() == 2);
  CHECK(transfers[0].bus == 1);
  CHECK(transfers[0].address == 0x70);
  CHECK(transfers[0].out == bytes({0x00, 5}));
  CHECK(transfers[0].in == 0);
  CHECK(transfers[1].out == bytes({0x8B}));
  CHECK(transfers[1].in == 2);

  CHECK_FALSE(chip.read({}));
  chip.board.acknowledges = false;
  CHECK_FALSE(chip.read({1, 1}));
  chip.board.acknowledges = true;
  chip.channel.input = 16;
  CHECK_FALSE(chip.read({1, 1}));
}

TEST_CASE("i2c_word: writes the register's number, reads two bytes, high first, with their sign") {
  OnBus chip(vm::DriverId::i2c_word, 0x48, 1);
  const auto read = [&](int high, int low) {
    REQUIRE(chip.read({high, low}));
    return chip.raw;
  };
  CHECK(read(0x19, 0x80) == 0x1980);
  CHECK(read(0x7F, 0xFF) == 32767);
  CHECK(read(0xE7, 0x00) == -25 * 256);
  CHECK(read(0x80, 0x00) == -32768);
  const auto& last = chip.board.transfers.back();
  CHECK(last.bus == 1);
  CHECK(last.address == 0x48);
  CHECK(last.out == bytes({1}));
  CHECK(last.in == 2);
  chip.board.acknowledges = false;
  CHECK_FALSE(chip.read({1, 1}));
  CHECK(chip.raw == -32768);
}

TEST_CASE("i2c_register: writes the register's number, reads two bytes, low first") {
  OnBus chip(vm::DriverId::i2c_register, 0x48, 0xA2);
  REQUIRE(chip.read({0x01, 0x80}));
  CHECK(chip.raw == 0x8001);
  REQUIRE(chip.board.transfers.size() == 1);
  CHECK(chip.board.transfers[0].address == 0x48);
  CHECK(chip.board.transfers[0].out == bytes({0xA2}));
}

TEST_CASE("a count becomes a value: scaled, rounded half away from zero, saturating") {
  vm::Channel channel{};
  const auto value = [&](std::int32_t raw, std::int32_t num, std::uint16_t den, Value offset) {
    channel.scale_num = num;
    channel.scale_den = den;
    channel.offset = offset;
    return layers::scaled(raw, channel);
  };
  CHECK(value(7, 1000, 1, 0) == 7000);
  CHECK(value(1, 5, 10, 0) == 1);
  CHECK(value(-1, 5, 10, 0) == -1);
  CHECK(value(1, 4, 10, 0) == 0);
  CHECK(value(1, 1, 3, 0) == 0);
  CHECK(value(2, 1, 3, 0) == 1);
  CHECK(value(100, 1000, 1, -50'000) == 50'000);
  CHECK(value(INT32_MAX, INT32_MAX, 1, 0) == vm::kValueMax);
  CHECK(value(INT32_MIN, INT32_MAX, 1, 0) == vm::kValueMin);
  CHECK(value(INT32_MIN, INT32_MIN, 1, vm::kValueMin) == vm::kValueMax);
  CHECK(value(INT32_MIN, 1, 1, 0) == vm::kValueMin);  // never the unknown
}

TEST_CASE("servo: a move at a speed takes way / speed, a setpoint every 20 ms, 500 to 2500 us") {
  Drive servo(vm::DriverId::servo, 0, 100 * kDeg);
  servo.begin(order(vm::Action::move, {{Param::to, 100 * kDeg}, {Param::at, 50 * kDeg}}));
  CHECK(servo.pulse() == 500);
  servo.run(2'000'000);
  CHECK(servo.pulse() == 1500);
  servo.run();
  CHECK(servo.now == 3'000'000);
  CHECK(servo.pulse() == 2500);
  CHECK(servo.setpoints() == 101);

  servo.begin(order(vm::Action::move, {{Param::to, 50 * kDeg}, {Param::over, 400}}));
  servo.run();
  CHECK(servo.now == 3'400'000);
  CHECK(servo.pulse() == 1500);
}

TEST_CASE("servo: its own pulses are at the ends of its range, also the other way round") {
  const auto pulse_at = [](vm::ServoPulses pulses, Value degrees) {
    Drive servo(vm::DriverId::servo, -90 * kDeg, 90 * kDeg);
    const std::array traits = {vm::Trait{pulses.at_min, 0, vm::TraitKind::pulse_at_min},
                               vm::Trait{pulses.at_max, 0, vm::TraitKind::pulse_at_max}};
    vm::Image image;
    image.actuators = std::span(&servo.wiring, 1);
    image.traits = traits;
    servo.outputs.own(image);
    servo.begin(order(vm::Action::move, {{Param::to, degrees * kDeg}, {Param::over, 400}}));
    servo.run();
    return servo.pulse();
  };
  CHECK(pulse_at({600, 2400}, -90) == 600);
  CHECK(pulse_at({600, 2400}, 90) == 2400);
  CHECK(pulse_at({600, 2400}, 45) == 1950);
  CHECK(pulse_at({2400, 600}, -90) == 2400);
  CHECK(pulse_at({2400, 600}, 90) == 600);
  CHECK(pulse_at({2400, 600}, 45) == 1050);
}

TEST_CASE("servo: BY is relative, has a direction, and ends at the range") {
  Drive servo(vm::DriverId::servo, 0, 100 * kDeg);
  const auto by = [&](Value amount, Value direction) {
    servo.begin(order(vm::Action::move, {{Param::by, amount}, {Param::direction, direction}}));
    servo.run();
    return servo.pulse();
  };
  CHECK(by(30 * kDeg, vm::kScale) == 1100);
  CHECK(by(10 * kDeg, -vm::kScale) == 900);
  CHECK(by(vm::kValueMax, vm::kScale) == 2500);
  CHECK(by(vm::kValueMax, -vm::kScale) == 500);
}

TEST_CASE("servo: without a target it sweeps to max, to min, and back to where it was") {
  Drive servo(vm::DriverId::servo, 0, 100 * kDeg);
  servo.begin(order(vm::Action::move, {{Param::to, 40 * kDeg}, {Param::at, 100 * kDeg}}));
  servo.run();
  const kernel::Time begin = servo.now;
  servo.begin(order(vm::Action::move, {{Param::at, 100 * kDeg}}));
  servo.run(begin + 600'000);
  CHECK(servo.pulse() == 2500);
  servo.run(begin + 1'600'000);
  CHECK(servo.pulse() == 500);
  servo.run();
  CHECK(servo.pulse() == 1300);
  CHECK(servo.now == begin + 2'000'000);

  SECTION("TIMES repeats it, OVER is the time of one") {
    const kernel::Time again = servo.now;
    servo.begin(order(vm::Action::move, {{Param::times, 3 * vm::kScale}, {Param::over, 4000}}));
    servo.run();
    CHECK(servo.now == again + 12'000'000);
  }
}

TEST_CASE("servo: a speed limit holds for OVER, too") {
  Drive servo(vm::DriverId::servo, 0, 100 * kDeg, 50 * kDeg);
  servo.begin(order(vm::Action::move, {{Param::to, 100 * kDeg}, {Param::over, 10}}));
  servo.run();
  CHECK(servo.now == 3'000'000);
}

TEST_CASE("servo: what cannot move is done at once") {
  Drive servo(vm::DriverId::servo, 0, 100 * kDeg, 0);
  servo.begin(order(vm::Action::move, {{Param::to, 100 * kDeg}}));
  CHECK(servo.wake == drivers::kDone);
  servo.begin(order(vm::Action::move));
  CHECK(servo.wake == drivers::kDone);
  servo.begin(order(vm::Action::move, {{Param::to, 10 * kDeg}, {Param::over, 100}}));
  CHECK(servo.wake == drivers::kDone);
}

TEST_CASE("servo: hold, rest, coast; a servo never driven has nothing to hold") {
  Drive servo(vm::DriverId::servo, -50 * kDeg, 50 * kDeg);
  servo.driver.release(servo.device(), vm::Release::hold, servo.now);
  CHECK(servo.setpoints() == 0);
  servo.begin(order(vm::Action::move, {{Param::to, 50 * kDeg}, {Param::at, 50 * kDeg}}));
  servo.run(1'500'000);
  servo.driver.release(servo.device(), vm::Release::hold, 1'500'000);
  CHECK(servo.pulse() == 2000);
  servo.driver.release(servo.device(), vm::Release::coast, 1'500'000);
  CHECK(servo.pulse() == 0);
  servo.driver.release(servo.device(), vm::Release::rest, 1'500'000);
  CHECK(servo.pulse() == 1500);  // 0 deg
}

// --- random orders ---

Value drawn_number() {
  return *rc::gen::weightedOneOf<Value>(
      {{3, rc::gen::inRange<Value>(-200'000, 200'000)},
       {1, rc::gen::element(vm::kValueMax, vm::kValueMin, 0, 1)}});
}

Drive drawn_drive(vm::DriverId driver) {
  const auto [min, max] = std::minmax({drawn_number(), drawn_number()});
  return Drive(driver, min, max, std::max(drawn_number(), 0));
}

// Random orders, each of which must end. `promised` turns a random order into one that the control layer can hand on.
template <typename Promised>
void obey_drawn(Drive& drive, vm::Action verb, Promised promised) {
  for (int i = 0; i < 4; ++i) {
    Order what;
    what.action = *rc::gen::element(verb, vm::Action::stop);
    what.given = *rc::gen::arbitrary<std::uint8_t>();
    for (Value& param : what.params)
      param = drawn_number();
    promised(what);
    drive.begin(what);
    for (int call = 0; call < 50 && drive.wake != drivers::kDone; ++call) {
      RC_ASSERT(drive.wake > drive.now);
      drive.now = drive.wake;
      drive.wake = drive.driver.advance(drive.device(), drive.now);
    }
    drive.driver.release(drive.device(), *rc::gen::element(vm::Release::hold, vm::Release::rest),
                         drive.now);
  }
}

TEST_CASE("any order ends, and no pulse leaves the servo's range") {
  const bool holds = rc::check("servo", [] {
    Drive servo = drawn_drive(vm::DriverId::servo);
    obey_drawn(servo, vm::Action::move, [&](Order& what) {
      Value& to = what.params[static_cast<std::size_t>(Param::to)];
      to = std::clamp(to, servo.wiring.min, servo.wiring.max);
      Value& at = what.params[static_cast<std::size_t>(Param::at)];
      at = std::clamp(at, 0, servo.wiring.speed_limit);
    });
    for (const std::uint32_t pulse : servo.board.pulses[7])
      RC_ASSERT(pulse >= 500U && pulse <= 2500U);
  });
  CHECK(holds);
}

TEST_CASE("pwm: a level at once, over a time, or for a time") {
  Drive lamp(vm::DriverId::pwm, 0, 100 * vm::kScale);
  lamp.begin(order(vm::Action::set, {{Param::to, 25 * vm::kScale}}));
  CHECK(lamp.wake == drivers::kDone);
  CHECK(lamp.pulse() == 5000);

  lamp.begin(order(vm::Action::set, {{Param::to, 75 * vm::kScale}, {Param::over, 1000}}));
  lamp.run(1'500'000);
  CHECK(lamp.pulse() == 10'000);
  lamp.run();
  CHECK(lamp.now == 2'000'000);
  CHECK(lamp.pulse() == 15'000);

  lamp.begin(order(vm::Action::set, {{Param::at, 50 * vm::kScale}, {Param::for_, 300}}));
  CHECK(lamp.pulse() == 10'000);
  lamp.run();
  CHECK(lamp.now == 2'300'000);
  CHECK(lamp.pulse() == 0);

  lamp.begin(order(vm::Action::set));
  CHECK(lamp.pulse() == 20'000);
  lamp.begin(order(vm::Action::stop));
  CHECK(lamp.pulse() == 0);
}

TEST_CASE("pwm: range and limit hold for TO, for AT, and for what says neither") {
  Drive slow(vm::DriverId::pwm, 0, 100 * vm::kScale, 40 * vm::kScale);
  slow.begin(order(vm::Action::set, {{Param::to, 90 * vm::kScale}}));
  CHECK(slow.pulse() == 8000);
  slow.begin(order(vm::Action::set));
  CHECK(slow.pulse() == 8000);
  slow.begin(order(vm::Action::set, {{Param::to, 30 * vm::kScale}}));
  CHECK(slow.pulse() == 6000);
  Drive dim(vm::DriverId::pwm, 10 * vm::kScale, 50 * vm::kScale);
  dim.begin(order(vm::Action::set));
  CHECK(dim.pulse() == 10'000);
  dim.begin(order(vm::Action::set, {{Param::at, 70 * vm::kScale}}));
  CHECK(dim.pulse() == 10'000);
  dim.begin(order(vm::Action::stop));
  CHECK(dim.pulse() == 0);
}

TEST_CASE("motor: TO has the way as its sign, AT and full power that of BACKWARD") {
  Drive motor(vm::DriverId::motor, -100 * vm::kScale, 100 * vm::kScale);
  const auto runs = [&](std::initializer_list<std::pair<Param, Value>> params) {
    motor.begin(order(vm::Action::set, params));
    CHECK(motor.wake == drivers::kDone);
    return motor.power();
  };
  CHECK(runs({{Param::to, 25 * vm::kScale}}) == 5000);
  CHECK(runs({{Param::to, -25 * vm::kScale}}) == -5000);
  CHECK(runs({{Param::to, 0}}) == 0);
  CHECK(runs({{Param::at, 60 * vm::kScale}}) == 12'000);
  CHECK(runs({{Param::at, 60 * vm::kScale}, {Param::direction, -vm::kScale}}) == -12'000);
  CHECK(runs({{Param::to, -30 * vm::kScale}, {Param::direction, -vm::kScale}}) == 6000);
  CHECK(runs({}) == 20'000);
  CHECK(runs({{Param::direction, -vm::kScale}}) == -20'000);
  motor.begin(order(vm::Action::stop));
  CHECK(motor.power() == 0);
}

TEST_CASE("motor: the range holds for AT, and the limit of SPEED for TO") {
  Drive slow(vm::DriverId::motor, -100 * vm::kScale, 100 * vm::kScale, 40 * vm::kScale);
  slow.begin(order(vm::Action::set, {{Param::to, -90 * vm::kScale}}));
  CHECK(slow.power() == -8000);
  slow.begin(order(vm::Action::set));
  CHECK(slow.power() == 8000);
  Drive forward(vm::DriverId::motor, 0, 50 * vm::kScale);
  forward.begin(order(vm::Action::set, {{Param::at, 70 * vm::kScale}}));
  CHECK(forward.power() == 10'000);
  forward.begin(order(vm::Action::set, {{Param::direction, -vm::kScale}}));
  CHECK(forward.power() == 0);
}

TEST_CASE("motor: OVER goes through a standstill, FOR ends off, a release is off or holds") {
  Drive motor(vm::DriverId::motor, -100 * vm::kScale, 100 * vm::kScale);
  motor.begin(order(vm::Action::set, {{Param::to, 50 * vm::kScale}}));
  motor.begin(order(vm::Action::set, {{Param::to, -50 * vm::kScale}, {Param::over, 1000}}));
  motor.run(1'250'000);
  CHECK(motor.power() == 5200);  // the last setpoint before that
  motor.run(1'500'000);
  CHECK(motor.power() == 0);
  motor.run();
  CHECK(motor.now == 2'000'000);
  CHECK(motor.power() == -10'000);
  motor.begin(order(vm::Action::set, {{Param::at, 20 * vm::kScale}, {Param::for_, 300}}));
  CHECK(motor.power() == 4000);
  motor.run();
  CHECK(motor.now == 2'300'000);
  CHECK(motor.power() == 0);
  motor.begin(order(vm::Action::set, {{Param::direction, -vm::kScale}}));
  motor.driver.release(motor.device(), vm::Release::hold, motor.now);
  CHECK(motor.power() == -20'000);
  motor.driver.release(motor.device(), vm::Release::coast, motor.now);
  CHECK(motor.power() == 0);
}

TEST_CASE("motor: whatever is ordered ends, inside the frame, and never on both pins") {
  const bool holds = rc::check("motor", [] {
    Drive motor = drawn_drive(vm::DriverId::motor);
    obey_drawn(motor, vm::Action::set, [](Order&) {});
    std::map<std::uint16_t, std::uint32_t> on;
    for (const auto& [pin, pulse] : motor.board.writes) {
      on[pin] = pulse;
      RC_ASSERT(pulse <= 20'000U);
      RC_ASSERT(on[7] == 0U || on[8] == 0U);
    }
  });
  CHECK(holds);
}

TEST_CASE("virtual_actuator and player: FOR, else OVER, else one second; STOP at once") {
  for (const vm::DriverId id : {vm::DriverId::virtual_actuator, vm::DriverId::player}) {
    const auto length = [id](const Order& what) {
      Drive drive(id, 0, 0);
      drive.begin(what);
      drive.run();
      return drive.now - 1'000'000;
    };
    CHECK(length(order(vm::Action::play)) == 1'000'000);
    CHECK(length(order(vm::Action::play, {{Param::for_, 2500}})) == 2'500'000);
    CHECK(length(order(vm::Action::move, {{Param::over, 100}})) == 100'000);
    CHECK(length(order(vm::Action::move, {{Param::over, 100}, {Param::for_, 300}})) == 300'000);
    CHECK(length(order(vm::Action::move, {{Param::over, -100}})) == 0);
    CHECK(length(order(vm::Action::stop)) == 0);
  }
}

TEST_CASE("servo: a sweep takes its OVER, also from an end of the range") {
  for (const Value from : {0 * kDeg, 45 * kDeg, 180 * kDeg})
    for (const Value times : {1, 3}) {
      Drive servo(vm::DriverId::servo, 0, 180 * kDeg);
      servo.begin(order(vm::Action::move, {{Param::to, from}}));
      servo.run();
      const kernel::Time before = servo.now;
      servo.begin(
          order(vm::Action::move, {{Param::over, 2000}, {Param::times, times * vm::kScale}}));
      servo.run();
      CAPTURE(from, times);
      CHECK(servo.now - before == static_cast<kernel::Duration>(times) * 2'000'000);
      CHECK(servo.state.motion.to == from);
    }
}

TEST_CASE("virtual_output: every command takes what the real one takes") {
  const auto length = [](vm::DriverId id, vm::VirtualOutput bus, const Order& what) {
    Drive drive(id, -100'000, 100'000);
    if (id == vm::DriverId::virtual_output) drive.wiring.bus = static_cast<std::uint8_t>(bus);
    drive.begin(what);
    drive.run();
    return drive.now;
  };
  using vm::Action;
  using vm::VirtualOutput;
  std::vector<std::pair<VirtualOutput, Order>> all = {
      {VirtualOutput::level, order(Action::set, {{Param::to, 50'000}})},
      {VirtualOutput::level, order(Action::set, {{Param::to, 50'000}, {Param::over, 1000}})},
      {VirtualOutput::level, order(Action::set, {{Param::at, 50'000}, {Param::for_, 2000}})},
      {VirtualOutput::level, order(Action::set, {{Param::over, 1000}, {Param::for_, 2000}})},
      {VirtualOutput::level, order(Action::stop, {{Param::over, 1000}})},
      {VirtualOutput::picture, order(Action::set, {{Param::item, 1000}})},
      {VirtualOutput::picture, order(Action::set, {{Param::item, 1000}, {Param::for_, 700}})},
      {VirtualOutput::picture, order(Action::set, {{Param::for_, 0}})},
      {VirtualOutput::picture, order(Action::stop)},
      {VirtualOutput::picture, order(Action::play)},
      {VirtualOutput::picture, order(Action::play, {{Param::times, 3000}})},
      {VirtualOutput::picture, order(Action::play, {{Param::times, 3000}, {Param::over, 1000}})},
      {VirtualOutput::picture, order(Action::play, {{Param::times, 9000}, {Param::over, 10}})},
      {VirtualOutput::tones, order(Action::stop)},
      {VirtualOutput::tones, order(Action::play, {{Param::at, 440'000}})},
      {VirtualOutput::tones, order(Action::play, {{Param::for_, 0}})},
      {VirtualOutput::tones, order(Action::play, {{Param::item, 2000}, {Param::for_, 1500}})}};
  for (Value melody = 0; melody < 9; ++melody)
    all.emplace_back(VirtualOutput::tones,
                     order(Action::play, {{Param::item, melody * vm::kScale}}));
  for (const auto& [like, what] : all) {
    const vm::DriverId real = like == VirtualOutput::level     ? vm::DriverId::pwm
                              : like == VirtualOutput::picture ? vm::DriverId::lights
                                                               : vm::DriverId::tones;
    CAPTURE(static_cast<int>(like), what.given, what.params);
    const kernel::Time taken = length(vm::DriverId::virtual_output, like, what);
    CHECK(taken == length(real, like, what));
    if (like == VirtualOutput::picture)
      CHECK(taken == length(vm::DriverId::ws2812_strip, like, what));
    if (like == VirtualOutput::level && what.action == Action::set)
      CHECK(length(vm::DriverId::virtual_output, VirtualOutput::picture, what) ==
            length(vm::DriverId::ws2812_strip, like, what));
    if (real == vm::DriverId::pwm)
      CHECK(length(vm::DriverId::motor, like, what) == length(real, like, what));
  }
}

TEST_CASE(
    "virtual_motion: way / speed, its place kept, and no faster than the limit however it is "
    "said") {
  const auto length = [](Drive& drive, const Order& what) {
    const kernel::Time before = drive.now;
    drive.begin(what);
    drive.run();
    return drive.now - before;
  };
  Drive joint(vm::DriverId::virtual_motion, -90'000, 90'000);
  joint.wiring.bus = static_cast<std::uint8_t>(vm::VirtualMotion::sweeps);
  joint.wiring.pin = 90;
  CHECK(length(joint, order(vm::Action::move, {{Param::to, 45'000}})) == 500'000);
  CHECK(length(joint, order(vm::Action::move, {{Param::to, 90'000}, {Param::at, 30'000}})) ==
        1'500'000);
  CHECK(length(joint, order(vm::Action::move, {{Param::to, 0}, {Param::over, 100}})) == 100'000);
  CHECK(length(joint, order(vm::Action::move, {{Param::at, 180'000}})) == 2'000'000);
  joint.wiring.speed_limit = 60'000;
  CHECK(length(joint, order(vm::Action::move, {{Param::to, 60'000}, {Param::over, 100}})) ==
        1'000'000);
  CHECK(length(joint, order(vm::Action::move, {{Param::to, 0}})) == 1'000'000);
  CHECK(length(joint, order(vm::Action::play)) == 1'000'000);

  Drive fan(vm::DriverId::virtual_motion, -100'000, 100'000);
  fan.wiring.pin = 0;
  fan.wiring.bus = static_cast<std::uint8_t>(vm::VirtualMotion::goes);
  fan.wiring.speed_limit = 20'000;
  CHECK(length(fan, order(vm::Action::move, {{Param::to, 100'000}, {Param::over, 1000}})) ==
        5'000'000);
  CHECK(length(fan, order(vm::Action::move, {{Param::to, 90'000}})) == 1'000'000);
  CHECK(length(fan, order(vm::Action::move)) == 1'000'000);
}
