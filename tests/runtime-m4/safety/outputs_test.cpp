// What an image cannot do, however it was made: reach a pin that is not its own or not an output, blind the SAFETY
// rules, command what its rules have not declared, or leave a motor running when it ends.
#include <array>
#include <functional>

#include <catch2/catch.hpp>

#include "tests/runtime-m4/rig.hpp"
#include "tests/runtime-m4/robot.hpp"
#include "tests/vm/image_builder.hpp"
#include "vm/opcode_traits.hpp"

using namespace robosync;
using robosync::test::Rig;
using vm::Refusal;
using vm::Section;

namespace {

const char* const kRobot = R"({
  "sensors": [
    {"name": "near", "type": "VIRTUAL", "channels": {"X": {"range": [0, 100]}}},
    {"name": "touch", "type": "I2C", "bus": 0, "address": "0x70", "device": "max34451",
     "channels": {"LEVEL": {"input": 2, "range": [0, 100], "rate": "50Hz"}}},
    {"name": "button", "type": "GPIO", "pin": 40, "device": "button"}],
  "actuators": [
    {"name": "arm", "type": "PWM", "pin": 3, "device": "servo", "range": ["0deg", "100deg"]},
    {"name": "motor", "type": "PWM", "pin": 4, "device": "pwm", "on_release": "hold"}]
})";

const char* const kProgram = R"(
SAFETY near_wall
  WHEN touch LEVEL > 50
  DO STOP ALL
END
WHEN near X > 10 AND button IS released
DO
  RUN motor TO 70%
  MOVE arm TO 100deg AT 500deg/s
END
)";

const char* const kWithoutMotor = R"(
WHEN near X > 10
DO MOVE arm TO 50deg
END
)";

std::vector<std::byte> program() {
  return test::compile(kProgram, kRobot);
}

// The program with one change in its tables, and a correct checksum.
using Change =
    std::function<void(vm::Sensor&, vm::Channel&, vm::Actuator& arm, vm::Actuator& motor)>;
std::vector<std::byte> patched(const Change& change, std::string_view sensor = "touch") {
  std::vector<std::byte> bytes = program();
  vm::Image image;
  REQUIRE(vm::view_image(bytes, image));
  const auto named = [&](const auto& records, std::string_view name) -> auto& {
    using Record = std::remove_cvref_t<decltype(records[0])>;
    for (const Record& record : records)
      if (image.string(record.name) == name) return const_cast<Record&>(record);
    FAIL("no " << name);
    return const_cast<Record&>(records[0]);
  };
  change(named(image.sensors, sensor), named(image.channels, "LEVEL"),
         named(image.actuators, "arm"), named(image.actuators, "motor"));
  vm::test::repair_crc(bytes);
  return bytes;
}

// The first command of a response, in memory.
vm::Word& command_of(const vm::Image& image, unsigned response) {
  const vm::Response& code = image.responses[response];
  for (const vm::Word& word : image.code.subspan(code.start, code.length))
    if (vm::traits_of(word).effect() == vm::Effect::command) return const_cast<vm::Word&>(word);
  FAIL("no command");
  return const_cast<vm::Word&>(image.code[0]);
}

Refusal refused(const Change& change, std::string_view sensor = "touch") {
  Rig rig;
  REQUIRE(rig.activate(program()).ok());
  const vm::Verdict verdict = rig.activate(patched(change, sensor));
  CHECK_FALSE(verdict.ok());
  CHECK(rig.status().activations == 1);
  return verdict.refusal;
}

}  // namespace

TEST_CASE("two actuators on one pin are refused") {
  refused([](auto&, auto&, auto& arm, auto& motor) { motor.pin = arm.pin; });
}

TEST_CASE("a pin that the board does not have is refused") {
  refused([](auto&, auto&, auto&, auto& motor) { motor.pin = 65535; });
  refused([](auto&, auto&, auto& arm, auto&) { arm.pin = 200; });
}

TEST_CASE("a motor has both of its pins for itself, and both are outputs that give power") {
  const auto motor_on = [](std::uint16_t forward, std::uint8_t back) {
    return [=](auto&, auto&, auto&, vm::Actuator& motor) {
      motor.driver = vm::DriverId::motor;
      motor.pin = forward;
      motor.bus = back;
    };
  };
  CHECK(refused(motor_on(4, 4)) == Refusal::shared_pin);
  CHECK(refused(motor_on(4, 3)) == Refusal::shared_pin);  // the arm's
  CHECK(refused(motor_on(3, 4)) == Refusal::shared_pin);
  CHECK(refused(motor_on(4, 40), "button") == Refusal::shared_pin);  // the button's
  CHECK(refused(motor_on(4, 41)) == Refusal::no_pin);
  CHECK(refused(motor_on(65535, 4)) == Refusal::no_pin);
  CHECK(refused(motor_on(4, 32)) == Refusal::no_pin);  // of a servo
  CHECK(refused(motor_on(32, 4)) == Refusal::no_pin);
  CHECK(refused([](auto&, auto&, auto&, auto& motor) { motor.pin = 33; }) == Refusal::no_pin);
  CHECK(refused([&](auto& touch, auto& level, auto& arm, auto& motor) {
          motor_on(4, 5)(touch, level, arm, motor);
          motor.safe = vm::Release::hold;
        }) == Refusal::drives_on);
  Rig rig;
  CHECK(rig.activate(patched(motor_on(4, 5))).ok());
}

TEST_CASE("a sensor with an echo has an output that may give short pulses, and an input") {
  const auto on = [](unsigned trigger, std::uint16_t echo) {
    return [=](vm::Sensor& sensor, auto&, auto&, auto&) {
      sensor.driver = vm::DriverId::hc_sr04;
      sensor.bus = static_cast<std::uint8_t>(trigger);
      sensor.address = echo;
      sensor.period_ms = 100;
    };
  };
  CHECK(refused(on(20, 20), "button") == Refusal::shared_pin);
  CHECK(refused(on(3, 41), "button") == Refusal::shared_pin);  // the arm's
  CHECK(refused(on(20, 3), "button") == Refusal::shared_pin);
  CHECK(refused(on(41, 42), "button") == Refusal::no_pin);  // an input
  CHECK(refused(on(200, 41), "button") == Refusal::no_pin);
  CHECK(refused(on(32, 41), "button") == Refusal::no_pin);  // of servos
  CHECK(refused(on(20, 21), "button") == Refusal::no_input);
  CHECK(refused(on(20, 0xFFFF), "button") == Refusal::no_input);
  Rig rig;
  CHECK(rig.activate(patched(on(20, 41), "button")).ok());
}

TEST_CASE("an encoder has an input whose edges are counted, and any input for the direction") {
  static constexpr std::array<policy::PinRange, 1> kCounted{{{41, 42}}};
  const auto on = [](std::uint16_t a, unsigned b) {
    return [=](vm::Sensor& sensor, auto&, auto&, auto&) {
      sensor.driver = vm::DriverId::encoder;
      sensor.address = a;
      sensor.bus = static_cast<std::uint8_t>(b);
    };
  };
  CHECK(refused(on(3, 41), "button") == Refusal::shared_pin);  // the arm's
  CHECK(refused(on(41, 3), "button") == Refusal::shared_pin);
  CHECK(refused(on(20, 41), "button") == Refusal::no_input);
  CHECK(refused(on(41, 20), "button") == Refusal::no_input);
  for (const auto& [a, b] : {std::pair{41, 42}, {42, 40}, {42, 255}, {40, 41}}) {
    Rig rig;
    rig.board.board_pins.echoes = kCounted;
    const vm::Verdict verdict = rig.activate(
        patched(on(static_cast<std::uint16_t>(a), static_cast<unsigned>(b)), "button"));
    CHECK(verdict.refusal == (a == 40 ? Refusal::no_input : Refusal::none));
  }
}

TEST_CASE("a sensor of a voltage has an analog input of the board for itself") {
  const auto on = [](std::uint16_t pin, unsigned bus = 0) {
    return [=](vm::Sensor& sensor, auto&, auto&, auto&) {
      sensor.driver = vm::DriverId::analog_input;
      sensor.bus = static_cast<std::uint8_t>(bus);
      sensor.address = pin;
    };
  };
  CHECK(refused(on(3), "button") == Refusal::shared_pin);  // the arm's
  for (const int pin : {0, 20, 43, 48, 0xFFFF})
    CHECK(refused(on(static_cast<std::uint16_t>(pin)), "button") == Refusal::no_input);
  CHECK(refused(on(44, 1), "button") == Refusal::bad_value);
  for (const int pin : {44, 47}) {
    Rig rig;
    CHECK(rig.activate(patched(on(static_cast<std::uint16_t>(pin)), "button")).ok());
  }
}

TEST_CASE("an I2C bus and an address that cannot be are refused") {
  refused([](auto& touch, auto&, auto&, auto&) { touch.bus = 5; });
  for (const int address : {0, 7, 0x78, 0xFFFF})
    refused([&](auto& touch, auto&, auto&, auto&) {
      touch.address = static_cast<std::uint16_t>(address);
    });
}

TEST_CASE("a pin that is no input of the board, or an actuator's, is not read") {
  for (const int pin : {0, 3, 35, 39, 44, 0xFFFF})
    CHECK(refused(
              [&](auto& button, auto&, auto& arm, auto&) {
                arm.pin = 10;
                button.address = static_cast<std::uint16_t>(pin);
              },
              "button") == Refusal::no_input);
  const auto takes = [](auto& button, auto&, auto& arm, auto&) { button.address = arm.pin; };
  CHECK(refused(takes, "button") == Refusal::shared_pin);
  const auto drives = [](auto& button, auto&, auto& arm, auto&) { arm.pin = button.address; };
  CHECK(refused(drives, "button") == Refusal::shared_pin);
  // Even if the button has another pin, this one is still not an output.
  const auto swaps = [](auto& button, auto&, auto& arm, auto&) {
    arm.pin = button.address;
    button.address = 41;
  };
  CHECK(refused(swaps, "button") == Refusal::no_pin);
}

TEST_CASE("a button that is never asked, or asked for a third level, is refused") {
  CHECK(refused([](auto& button, auto&, auto&, auto&) { button.period_ms = 0; }, "button") ==
        Refusal::bad_value);
  CHECK(refused([](auto& button, auto&, auto&, auto&) { button.bus = 2; }, "button") ==
        Refusal::bad_value);
}

TEST_CASE("a sensor that measures cannot be made one that is fed") {
  refused([](auto& touch, auto&, auto&, auto&) { touch.period_ms = 0; });
}

TEST_CASE("a sensor that SAFETY reads grows stale") {
  refused([](auto&, auto& level, auto&, auto&) { level.stale_ms = 0; });
}

TEST_CASE("a motor that would drive on in its safe state is refused") {
  refused([](auto&, auto&, auto&, auto& motor) { motor.safe = vm::Release::hold; });
  Rig rig;
  CHECK(rig.activate(patched([](auto&, auto&, auto& arm, auto&) { arm.safe = vm::Release::hold; }))
            .ok());
}

TEST_CASE("a motor that the next program does not have stands still") {
  Rig rig;
  rig.board.answers.assign(10000, std::byte{0});
  REQUIRE(rig.activate(program()).ok());
  rig.feed(0, 20);
  rig.run(500);
  REQUIRE(rig.board.pwm_read(4) == 14'000);
  REQUIRE(rig.activate(test::compile(kWithoutMotor, kRobot)).ok());
  CHECK(rig.board.pwm_read(4) == 0);
}

TEST_CASE("a motor runs both ways through all layers, and backward is stopped as forward is") {
  const char* const robot = R"({
    "sensors": [{"name": "near", "type": "VIRTUAL", "channels": {"X": {"range": [0, 100]}}}],
    "actuators": [{"name": "wheel", "type": "PWM", "pins": [4, 5], "device": "motor"}]})";
  const auto bytes = test::compile(
      "WHEN near X > 10\nDO RUN wheel TO 25%\nEND\nWHEN near X > 50\nDO RUN wheel BACKWARD "
      "SLOWLY\nEND\n",
      robot);
  Rig rig;
  REQUIRE(rig.activate(bytes).ok());
  rig.feed(0, 20);
  rig.run(500);
  CHECK(rig.board.pwm_read(4) == 5'000);
  CHECK(rig.board.pwm_read(5) == 0);
  rig.feed(0, 60);
  rig.run(1000);
  CHECK(rig.board.pwm_read(4) == 0);
  CHECK(rig.board.pwm_read(5) == 6'000);
  rig.runtime.stop();
  rig.run(1100);
  CHECK(rig.board.pwm_read(5) == 0);
  rig.runtime.resume();
  rig.run(1500);
  CHECK(rig.board.pwm_read(5) == 0);
  for (const int near : {0, 20, 60}) {
    rig.feed(0, near);
    rig.run(rig.kernel.now() / 1000 + 100);
  }
  REQUIRE(rig.board.pwm_read(5) == 6'000);
  rig.runtime.clear();
  CHECK(rig.board.pwm_read(5) == 0);
}

TEST_CASE("nothing is driven when no program runs") {
  Rig rig;
  rig.board.answers.assign(10000, std::byte{0});
  REQUIRE(rig.activate(program()).ok());
  rig.feed(0, 20);
  rig.run(500);
  rig.runtime.clear();
  CHECK(rig.board.pwm_read(3) == 0);
  CHECK(rig.board.pwm_read(4) == 0);
}

// Commands from a behaviour's thread are not trusted: its rule has declared what it commands. Here its code is
// damaged after it was verified.
TEST_CASE("a command to an actuator that the rule does not have goes nowhere") {
  Rig rig;
  REQUIRE(rig.activate(test::compile("WHEN near X > 10\nDO MOVE arm TO 50deg\nEND\n"
                                     "WHEN near X > 50\nDO RUN motor TO 70%\nEND\n",
                                     kRobot))
              .ok());
  vm::Word& first = command_of(rig.runtime.image(), 0);
  const vm::Word second = command_of(rig.runtime.image(), 1);
  REQUIRE(vm::operand_a(first) != vm::operand_a(second));
  first = second;
  rig.feed(0, 20);
  rig.run(500);
  CHECK(rig.board.pwm_read(3) == 0);
  CHECK(rig.board.pwm_read(4) == 0);
}

TEST_CASE("a verb that the actuator does not know goes nowhere") {
  Rig rig;
  REQUIRE(rig.activate(test::compile("WHEN near X > 10\nDO MOVE arm TO 50deg\nEND\n"
                                     "WHEN near X > 50\nDO RUN motor TO 70%\nEND\n",
                                     kRobot))
              .ok());
  vm::Word& first = command_of(rig.runtime.image(), 0);
  const vm::Word second = command_of(rig.runtime.image(), 1);
  first = vm::encode(vm::Opcode::cmd, vm::operand_a(first), vm::operand_b(second), vm::kNoWord);
  rig.feed(0, 20);
  rig.run(500);
  CHECK(rig.board.pwm_read(3) == 0);
}
