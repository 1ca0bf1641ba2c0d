// Analog inputs: from counts to readings, one that does not answer, and the use of a pin that may be an output, too.
#include <array>

#include <catch2/catch.hpp>

#include "runtime-m4/drivers/drivers.hpp"
#include "runtime-m4/guard/output_guard.hpp"
#include "tests/runtime-m4/rig.hpp"
#include "tests/runtime-m4/robot.hpp"

using namespace robosync;
using test::Rig;

namespace {

const char* const kSafeGrip = R"(
SAFETY soft_hand
  WHEN grip FORCE > 70%
  DO STOP claw
  RESUME WHEN grip FORCE < 30%
END
WHEN grip FORCE > 50% DO LOG "held" END
)";

std::string wired(std::string_view sensor) {
  return R"({"sensors": [)" + std::string(sensor) +
         R"(], "actuators": [{"name": "claw", "type": "PWM", "pin": 3, "device": "servo"}]})";
}
const std::string kGrip = wired(R"({"name": "grip", "type": "ADC", "pin": 45, "device": "force"})");
const std::string kFed = wired(R"({"name": "grip", "type": "VIRTUAL", "device": "force"})");

const char* const kOfGrip = "WHEN grip FORCE > 0% DO LOG \"it\" END\n";

constexpr vm::Limits kAnyDriver{};

struct Gripper {
  explicit Gripper(const std::string& program = kSafeGrip, const std::string& wiring = kGrip) {
    rig.board.voltage_of = [this](std::uint16_t pin) {
      return pin == 45 ? counts : std::optional<std::uint16_t>(4000);
    };
    REQUIRE(rig.activate(test::compile(program, wiring)).ok());
  }
  std::optional<std::uint16_t> counts = 0;
  Rig rig;
};

// One program with a sensor on a ring, one with a servo there, one with nothing.
struct Rings {
  static constexpr std::array<policy::PinRange, 1> kRings{{{0, 2}}};
  Rings() {
    board.board_pins.analog = kRings;
    board.board_pins.inputs = kRings;
  }
  vm::Image image(const std::string& program, const std::string& wiring) {
    bytes.push_back(test::compile(program, wiring));
    vm::Image image;
    REQUIRE(vm::verify(bytes.back(), kAnyDriver, image).ok());
    return image;
  }
  vm::Image on(std::uint16_t pin) {
    vm::Image made = image(kOfGrip, kGrip);
    const_cast<vm::Sensor&>(made.sensors[0]).address = pin;
    return made;
  }
  vm::Image with_switch(std::uint16_t pin) {
    vm::Image made = image(
        "WHEN bumper IS closed DO LOG \"it\" END\n",
        R"({"sensors": [{"name": "bumper", "type": "GPIO", "pin": 40, "device": "switch"}]})");
    const_cast<vm::Sensor&>(made.sensors[0]).address = pin;
    return made;
  }
  std::vector<std::vector<std::byte>> bytes = [] {
    std::vector<std::vector<std::byte>> none;
    none.reserve(16);
    return none;
  }();
  kernel::Kernel kernel;
  test::NotingBoard board;
  guard::OutputGuard guard{kernel, board};
  using Handed = std::vector<std::pair<std::uint16_t, bool>>;
  Handed handed() { return std::exchange(board.handed, {}); }
};

}  // namespace

TEST_CASE("analog_input: a count is a count, of its own pin; no answer is no reading") {
  test::NotingBoard board;
  vm::Sensor sensor{};
  sensor.address = 45;
  std::int32_t raw = -1;
  std::optional<std::uint16_t> counts;
  board.voltage_of = [&](std::uint16_t pin) {
    return pin == 45 ? counts : std::optional<std::uint16_t>(1);
  };
  const auto read = [&] {
    return drivers::driver(vm::DriverId::analog_input).read(board, sensor, {}, raw);
  };
  for (const int value : {0, 1, 2048, 4095}) {
    counts = static_cast<std::uint16_t>(value);
    REQUIRE(read());
    CHECK(raw == value);
  }
  counts.reset();
  CHECK_FALSE(read());
}

TEST_CASE("analog_input: 0 to 4095 are 0 to 100 percent") {
  for (const auto& [counts, below, above] : {std::tuple{0, "0.001", "-1"},
                                             {41, "1.002", "1"},
                                             {2048, "50.1", "49.9"},
                                             {4095, "101", "99.999"}}) {
    Gripper robot(std::string("WHEN grip FORCE < ") + below + "% AND grip FORCE > " + above +
                  "% DO LOG \"it\" END\n");
    robot.counts = static_cast<std::uint16_t>(counts);
    robot.rig.run(100);
    CAPTURE(counts);
    CHECK(robot.rig.only("log").find("it") != std::string::npos);
  }
}

TEST_CASE("analog_input: the last bits, which are never still, are no news") {
  Gripper robot(kOfGrip);
  robot.counts = 2000;
  robot.rig.run(100);
  const std::string before = robot.rig.only("input");
  CHECK(before != "");
  for (unsigned ms = 100; ms < 500; ms += 20) {
    robot.counts = static_cast<std::uint16_t>(1990 + ms / 20 % 20);
    robot.rig.run(ms);
  }
  CHECK(robot.rig.only("input") == before);
  robot.counts = 2021;  // 0.51 % more
  robot.rig.run(550);
  CHECK(robot.rig.only("input") != before);
}

TEST_CASE(
    "analog_input: a converter that does not answer is told, unknown after a while, and SAFETY "
    "trips") {
  Gripper robot;
  robot.counts = 1000;
  robot.rig.run(1000);
  CHECK(robot.rig.only("trip").empty());
  CHECK(robot.rig.only("silent").empty());
  robot.counts.reset();
  robot.rig.run(1080);
  CHECK(robot.rig.only("trip").empty());  // 100 ms after the last one
  robot.rig.run(1140);
  CHECK(robot.rig.only("trip").find("trip r0") != std::string::npos);
  CHECK(robot.rig.only("silent") != "");
  robot.counts = 1000;
  robot.rig.run(2000);
  CHECK(robot.rig.only("answers") != "");
  CHECK(robot.rig.only("resume") != "");
}

TEST_CASE("analog_input: SAFETY knows before anything moves, and what presses is known") {
  Gripper robot;
  robot.counts = 3000;
  robot.rig.run(100);
  CHECK(robot.rig.only("trip").find("trip r0") != std::string::npos);
}

TEST_CASE(
    "guard: a pin that is measured is let go for the program that measures it, and no longer") {
  Rings rings;
  const vm::Image zero = rings.on(0), two = rings.on(2);
  const vm::Image none = rings.image(
      "AT START DO MOVE claw TO 90deg END\n",
      R"({"actuators": [{"name": "claw", "type": "PWM", "pin": 0, "device": "servo"}]})");
  rings.guard.own(none);
  CHECK(rings.handed().empty());
  rings.guard.own(zero);
  CHECK(rings.handed() == Rings::Handed{{0, true}});
  rings.guard.own(two);
  CHECK(rings.handed() == Rings::Handed{{0, false}, {2, true}});
  rings.guard.own(none);
  CHECK(rings.handed() == Rings::Handed{{2, false}});
  rings.guard.drive(0, 1500, 0);
  CHECK(rings.board.pulses[0].back() == 1500);
  rings.guard.own(zero);
  CHECK(rings.board.pulses[0].back() == 0);  // off, before let_go()
  CHECK(rings.handed() == Rings::Handed{{0, true}});
  rings.guard.disown();
  CHECK(rings.handed() == Rings::Handed{{0, false}});
  rings.guard.disown();
  CHECK(rings.handed().empty());
}

TEST_CASE("guard: a pin that both programs measure is not driven in between") {
  Rings rings;
  const vm::Image before = rings.on(1), after = rings.on(1);
  rings.guard.own(before);
  static_cast<void>(rings.handed());
  rings.guard.own(after);
  CHECK(rings.handed().empty());
}

TEST_CASE("guard: an output whose level is read is let go for the program that reads it") {
  Rings rings;
  const vm::Image one = rings.with_switch(1), none = rings.image(kOfGrip, kFed);
  const vm::Image motor = rings.image(
      "AT START DO RUN wheel TO 50% END\n",
      R"({"actuators": [{"name": "wheel", "type": "PWM", "pins": [0, 1], "device": "motor"}]})");
  rings.guard.own(motor);
  rings.guard.drive_either(0, -9000, 0);
  REQUIRE(rings.board.pulse(1) == 9000);
  std::vector<std::uint32_t> then;
  rings.board.on_let_go = [&](std::uint16_t pin) { then.push_back(rings.board.pulse(pin)); };
  rings.guard.own(one);
  CHECK(rings.handed() == Rings::Handed{{1, true}});
  CHECK(then == std::vector<std::uint32_t>{0});  // it was off before
  CHECK(rings.board.read.at(1) == boards::Reads::level);
  rings.board.writes.clear();
  for (const std::int32_t pulse : {5000, -5000})
    rings.guard.drive_either(0, pulse, 0);  // of the program before
  CHECK(rings.board.writes.empty());
  rings.guard.own(none);
  CHECK(rings.handed() == Rings::Handed{{1, false}});
  rings.guard.own(one);
  rings.guard.disown();
  CHECK(rings.handed() == Rings::Handed{{1, true}, {1, false}});
}

TEST_CASE("guard: a pin of which the next program reads something else is not driven in between") {
  Rings rings;
  const vm::Image voltage = rings.on(2), level = rings.with_switch(2);
  for (unsigned turn = 0; turn < 2; ++turn) {
    rings.guard.own(voltage);
    CHECK(rings.board.read.at(2) == boards::Reads::voltage);
    rings.guard.own(level);
    CHECK(rings.board.read.at(2) == boards::Reads::level);
  }
  CHECK(rings.handed() == Rings::Handed{{2, true}, {2, true}, {2, true}, {2, true}});
  rings.guard.own(level);
  CHECK(rings.handed().empty());
  rings.guard.disown();
  CHECK(rings.handed() == Rings::Handed{{2, false}});
}

TEST_CASE("guard: a panel's pin is free of it before its level is read") {
  Rings rings;
  static constexpr std::array<policy::PinRange, 1> kPanels{{{0, 2}}};
  rings.board.board_pins.panels = kPanels;
  const vm::Image panel = rings.image(
      "AT START DO LIGHT eyes red END\n",
      R"({"board": "microbit-v2", "actuators": [{"name": "eyes", "pin": 1, "device": "ws2812_strip", "lights": 4}]})");
  unsigned ended = 0;
  rings.board.on_let_go = [&](std::uint16_t) { ended = rings.board.noting_panel.ends; };
  rings.guard.own(panel);
  rings.guard.own(rings.with_switch(1));
  CHECK(ended == 1);
}

TEST_CASE("guard: an input that is no output is not let go") {
  Rings rings;
  for (const int pin : {3, 5, 40, 63, 64, 0xFFFF})
    rings.guard.own(rings.with_switch(static_cast<std::uint16_t>(pin)));
  rings.guard.disown();
  CHECK(rings.handed().empty());
}

TEST_CASE(
    "guard: a pin that is no analog input of the board is not let go, whatever the image says") {
  Rings rings;
  for (const int pin : {3, 5, 45, 0xFFFF})
    rings.guard.own(rings.on(static_cast<std::uint16_t>(pin)));
  for (const auto& [pin, let_go] : rings.handed())
    CHECK_FALSE(let_go);
  rings.guard.own(rings.image(kOfGrip, kFed));
  for (const auto& [pin, let_go] : rings.handed())
    CHECK_FALSE(let_go);
}
