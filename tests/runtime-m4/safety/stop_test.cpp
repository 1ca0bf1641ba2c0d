// A person's stop: at any time, whatever runs or is activated, until the person's resume.
#include <catch2/catch.hpp>

#include "tests/runtime-m4/layers/draw.hpp"
#include "tests/runtime-m4/rig.hpp"
#include "tests/runtime-m4/robot.hpp"
#include "tests/vm/image_builder.hpp"

using namespace robosync;
using robosync::test::Rig;

namespace {

const char* const kFourOutputs = R"({
  "sensors": [{"name": "near", "type": "VIRTUAL", "channels": {"X": {"range": [0, 100]}}}],
  "actuators": [
    {"name": "arm", "type": "PWM", "pin": 3, "device": "servo", "range": ["0deg", "100deg"]},
    {"name": "motor", "type": "PWM", "pin": 4, "device": "pwm", "on_release": "hold"},
    {"name": "slow_motor", "type": "PWM", "pin": 34, "device": "pwm"},
    {"name": "small_arm", "type": "PWM", "pin": 32, "device": "servo", "range": ["0deg", "100deg"]}]
})";

const char* const kMoving = R"(
SAFETY too_near
  WHEN near X > 90
  DO STOP motor
  RESUME WHEN near X < 80
END
WHEN near X > 10
DO
  RUN motor TO 70%
  RUN slow_motor TO 100%
  MOVE arm TO 100deg AT 20deg/s
  MOVE small_arm TO 100deg AT 500deg/s
END
)";

std::vector<std::byte> moving_program() {
  return test::compile(kMoving, kFourOutputs);
}

bool all_off(const Rig& rig) {
  return rig.board.pwm_read(3) == 0 && rig.board.pwm_read(4) == 0 && rig.board.pwm_read(32) == 0 &&
         rig.board.pwm_read(34) == 0;
}

}  // namespace

TEST_CASE("stop puts all outputs into their safe state at once, and they stay there until resume") {
  Rig rig;
  REQUIRE(rig.activate(moving_program()).ok());
  rig.feed(0, 20);
  rig.run(500);
  REQUIRE(rig.board.pwm_read(4) == 14'000);
  rig.runtime.stop();
  rig.run(500);
  CHECK(all_off(rig));
  CHECK(rig.runtime.stopped());
  rig.feed(0, 5);
  rig.run(600);
  rig.feed(0, 20);
  rig.run(2000);
  CHECK(all_off(rig));
  rig.runtime.resume();
  rig.feed(0, 5);
  rig.run(2100);
  CHECK(all_off(rig));  // interrupted commands do not continue on their own
  rig.feed(0, 20);
  rig.run(2500);
  CHECK(rig.board.pwm_read(4) == 14'000);
}

TEST_CASE("a stop outlasts programs that come and go") {
  Rig rig;
  rig.runtime.stop();
  rig.run(10);
  for (unsigned round = 0; round < 2; ++round) {
    REQUIRE(rig.activate(moving_program()).ok());
    rig.feed(0, 20);
    rig.run(rig.kernel.now() / 1000 + 500);
    CHECK(all_off(rig));
    rig.runtime.clear();
  }
  REQUIRE(rig.activate(moving_program()).ok());
  rig.runtime.resume();
  rig.feed(0, 20);
  rig.run(rig.kernel.now() / 1000 + 500);
  CHECK(rig.board.pwm_read(4) == 14'000);
}

TEST_CASE(
    "what a stop interrupts and keeps from starting is told so, whatever behaviours there are") {
  const char* const two =
      "BEHAVIOR alpha PRIORITY 60\nWHEN near X > 95\nDO RUN motor TO 5%\nEND\nEND\n"
      "BEHAVIOR beta PRIORITY 40\nWHEN near X > 10\nDO MOVE arm TO 90deg OVER 3s\nEND\nEND\n";
  Rig rig;
  REQUIRE(rig.activate(test::compile(two, kFourOutputs)).ok());
  rig.feed(0, 20);
  rig.run(100);
  rig.runtime.stop();
  rig.run(200);
  CHECK(rig.only("interrupt") == "100 #2 interrupt r1 by stop\n");
  rig.feed(0, 5);
  rig.run(300);
  rig.feed(0, 20);
  rig.run(400);
  CHECK(rig.only("lose") == "300 #4 lose r1 DO to stop\n");
}

TEST_CASE("where SAFETY and a stop both halt, each is told of what it has done") {
  Rig rig;
  REQUIRE(rig.activate(moving_program()).ok());
  rig.feed(0, 20);
  rig.run(50);
  rig.runtime.stop();
  rig.run(100);
  CHECK(rig.only("interrupt") == "50 #2 interrupt r2 by stop\n");
  const auto rises = [&](std::uint64_t at_ms) {
    rig.feed(0, 5);
    rig.run(at_ms);
    rig.feed(0, 20);
    rig.run(at_ms + 50);
    return rig.lines.empty() ? "" : rig.only("lose").substr(rig.only("lose").rfind("lose"));
  };
  CHECK(rises(200) == "lose r2 DO to stop\n");
  rig.feed(0, 95);  // the rule trips while everything is stopped, …
  rig.run(300);
  rig.runtime.resume();  // … and still holds the motor after the resume
  rig.feed(0, 85);
  rig.run(400);
  rig.feed(0, 5);  // the rule lets go
  rig.run(500);
  rig.feed(0, 20);
  rig.run(600);
  CHECK(rig.only("win").rfind("win r2") > rig.only("win").find("win r2"));
  rig.feed(0, 95);
  rig.run(700);
  CHECK(rig.only("interrupt").ends_with("interrupt r2 by b0\n"));
  rig.runtime.stop();
  rig.run(800);
  CHECK(rises(900) == "lose r2 DO to stop\n");  // the rule has let go in the meantime
}

// Its motor is commanded again and again without a trigger: it runs as soon as it may.
TEST_CASE(
    "resume leaves halted what a SAFETY rule halts, and the rule's own end leaves stopped what "
    "is") {
  Rig rig;
  REQUIRE(rig.activate(test::compile("SAFETY too_near\n  WHEN near X > 90\n  DO STOP motor\n"
                                     "  RESUME WHEN near X < 80\nEND\n"
                                     "EVERY 50ms\nDO RUN motor TO 70%\nEND\n",
                                     kFourOutputs))
              .ok());
  rig.feed(0, 20);
  rig.run(100);
  REQUIRE(rig.board.pwm_read(4) == 14'000);
  rig.feed(0, 95);  // trips
  rig.run(200);
  CHECK(rig.board.pwm_read(4) == 0);
  rig.runtime.stop();
  rig.run(300);
  rig.runtime.resume();
  rig.run(500);
  CHECK(rig.board.pwm_read(4) == 0);
  rig.runtime.stop();
  rig.run(600);
  rig.feed(0, 5);  // the rule lets the motor go
  rig.run(800);
  CHECK(rig.board.pwm_read(4) == 0);
  rig.runtime.resume();
  rig.run(1000);
  CHECK(rig.board.pwm_read(4) == 14'000);
}

TEST_CASE("the board's limits hold whatever the robot's file says") {
  Rig rig;
  REQUIRE(rig.activate(moving_program()).ok());
  rig.feed(0, 20);
  rig.run(3000);
  for (const std::uint32_t pulse : rig.board.pulses[32])
    CHECK((pulse == 0 || (pulse >= 1000 && pulse <= 2000)));
  CHECK(rig.board.pwm_read(32) == 2000);  // 2,500 were wanted
  const auto& slow = rig.board.pulses[34];
  for (std::size_t i = 1; i < slow.size(); ++i)
    CHECK(slow[i] <= slow[i - 1] + 50 * 20);
  CHECK(rig.board.pwm_read(34) == 10'000);
}

TEST_CASE(
    "a servo's own pulses go through all layers, also in its safe state, and the board's limits "
    "hold") {
  auto with = [](const std::string& pin, const std::string& pulses, bool widened) {
    std::vector<std::byte> bytes = test::compile(
        "SAFETY too_near\n  WHEN near X > 90\n  DO STOP arm\n  RESUME WHEN near X < 80\nEND\n"
        "WHEN near X > 10\nDO MOVE arm TO 100deg\nEND\n",
        R"({"sensors": [{"name": "near", "type": "VIRTUAL", "channels": {"X": {"range": [0, 100]}}}],
            "actuators": [{"name": "arm", "type": "PWM", "pin": )" +
            pin + R"(, "device": "servo", "range": ["0deg", "200deg"], "safe": "rest", "pulse": )" +
            pulses + "}]}");
    if (!widened) return bytes;
    vm::Image image;
    REQUIRE(vm::view_image(bytes, image));
    for (const vm::Trait& trait : image.traits)
      const_cast<vm::Trait&>(trait).value = 2500;
    vm::test::repair_crc(bytes);
    return bytes;
  };
  const auto pulses_of = [](const std::vector<std::byte>& bytes, std::uint16_t pin) {
    Rig rig;
    REQUIRE(rig.activate(bytes).ok());
    rig.feed(0, 20);
    rig.run(5000);
    const std::uint32_t moved = rig.board.pwm_read(pin);
    rig.feed(0, 95);
    rig.run(10'000);
    return std::pair(moved, rig.board.pwm_read(pin));
  };
  CHECK(pulses_of(with("3", R"(["600us", "2ms"])", false), 3) == std::pair(1300U, 600U));
  CHECK(pulses_of(with("3", R"(["2.2ms", "1ms"])", false), 3) == std::pair(1600U, 2200U));
  CHECK(pulses_of(with("32", R"(["1.8ms", "1.2ms"])", true), 32) == std::pair(2000U, 2000U));
}

// Uploads of images with damaged tables, readings, stops, resumes and program ends, in any order.
TEST_CASE("no image, reading or stop drives what it must not") {
  test::Draw draw(17);
  const std::vector<std::byte> good = moving_program();
  Rig rig;
  bool stopped = false;
  unsigned ran = 0;
  for (unsigned event = 0; event < 1500; ++event) {
    switch (draw.below(8)) {
      case 0: {
        std::vector<std::byte> bytes = good;
        vm::Image image;
        REQUIRE(vm::view_image(bytes, image));
        auto& actuator = const_cast<vm::Actuator&>(image.actuators[draw.below(4)]);
        const auto any = static_cast<vm::Value>(draw.below(UINT32_MAX));
        switch (draw.below(7)) {
          case 0:
            actuator.pin = static_cast<std::uint16_t>(draw.below(40));
            break;
          case 1:
            actuator.max = any;
            break;
          case 2:
            actuator.min = any;
            break;
          case 3:
            actuator.speed_limit = any;
            break;
          case 4:
            actuator.driver = draw.one_in(2) ? vm::DriverId::pwm : vm::DriverId::servo;
            break;
          case 5:
            actuator.driver = vm::DriverId::motor;
            actuator.bus = static_cast<std::uint8_t>(draw.below(40));
            break;
          default:
            actuator.safe = static_cast<vm::Release>(draw.below(3));
        }
        vm::test::repair_crc(bytes);
        if (rig.activate(bytes).ok()) ++ran;
        break;
      }
      case 1:
        stopped = !stopped;
        stopped ? rig.runtime.stop() : rig.runtime.resume();
        break;
      case 2:
        if (draw.one_in(4)) rig.runtime.clear();
        break;
      default:
        rig.feed(0, static_cast<int>(draw.below(100)));
    }
    rig.run(rig.kernel.now() / 1000 + draw.below(40));
    for (auto& entry : rig.board.pulses) {
      const std::uint16_t pin = entry.first;  // clang 14: lambdas cannot capture bindings
      auto& pulses = entry.second;
      const policy::PinLimit* const limit = policy::limit_of(boards::kPins, pin);
      REQUIRE(limit != nullptr);
      for (const std::uint32_t pulse : pulses)
        REQUIRE((pulse == 0 || (pulse >= limit->shortest && pulse <= limit->longest)));
      const std::uint32_t now = pulses.back();
      const auto has_it = [pin](const vm::Actuator& actuator) {
        return test::has_pin(actuator, pin);
      };
      const bool owned =
          rig.runtime.running() && std::ranges::any_of(rig.runtime.image().actuators, has_it);
      REQUIRE((owned || now == 0));
      if (stopped && now != 0) {  // a servo that holds, and nothing else
        const auto& actuators = rig.runtime.image().actuators;
        const auto owner = std::ranges::find_if(actuators, has_it);
        REQUIRE(owner->driver == vm::DriverId::servo);
      }
      pulses = {now};
    }
  }
  CHECK(ran > 50);
}
