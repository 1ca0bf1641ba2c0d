// A panel of lights: what the board is told to show, when, and that it is dark whenever nothing may be shown.
// tests/runtime-m4/boards/panel_test.cpp tests a board's output.
#include <set>

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "runtime-m4/guard/output_guard.hpp"
#include "tests/runtime-m4/drivers/panel_robot.hpp"
#include "tests/support/golden.hpp"
#include "tests/vm/image_builder.hpp"

using namespace robosync;

namespace ws2812_test {
namespace {

using Pictures = std::vector<std::uint32_t>;

std::string with_panel(const std::string& more = "") {
  return R"({"board": "microbit-v2",
             "sensors": [{"name": "near", "type": "VIRTUAL", "channels": {"X": {"range": [0, 100]}}}],
             "actuators": [{"name": "face", "pin": 1, "device": "ws2812")" +
         more + R"(}, {"name": "arm", "type": "PWM", "pin": 0, "device": "servo"}]})";
}

struct Shown : test::PanelRobot {
  explicit Shown(const std::string& body, const std::string& more = "")
      : PanelRobot(body, with_panel(more)) {}
};

std::uint32_t happy() {
  static const std::uint32_t picture = Shown("SHOW face happy").now();
  return picture;
}

nlohmann::json words(const std::string& device) {
  return nlohmann::json::parse(testing::read_file(std::filesystem::path(ROBOSYNC_SOURCE_DIR) /
                                                  "stdlib/devices" / (device + ".json")))
      .at("words");
}

}  // namespace

TEST_CASE("ws2812: its words are those of a matrix, and each has the picture of the lights") {
  CHECK(words("ws2812") == words("matrix"));
  std::set<std::uint32_t> seen;
  const nlohmann::json known = words("ws2812");
  for (const auto& [word, settings] : known.items()) {
    const std::string rsl = test::stops_when_far("SHOW face " + word);
    test::Rig lights;
    REQUIRE(lights
                .activate(test::compile(rsl, R"({"board": "microbit-v2",
        "sensors": [{"name": "near", "type": "VIRTUAL", "channels": {"X": {"range": [0, 100]}}}],
        "actuators": [{"name": "face", "device": "lights"}]})"))
                .ok());
    lights.feed(0, 6);
    lights.run(20);
    lights.feed(0, 20);
    lights.run(50);
    REQUIRE_FALSE(lights.board.pictures.empty());
    const Shown panel("SHOW face " + word);
    CHECK(panel.now() == lights.board.pictures.back());
    seen.insert(panel.now());
  }
  CHECK(seen.size() == known.size() - 1);
}

TEST_CASE("ws2812: the board has what robot.json says of the panel") {
  const auto panel_of = [](const std::string& more) {
    const Shown robot("SHOW face happy", more);
    REQUIRE(robot.rig.board.noting_panel.begun.size() == 1);
    return robot.rig.board.noting_panel.begun.front();
  };
  const policy::Panel usual = panel_of("");
  CHECK(usual.pin == 1);
  CHECK(usual.side == 5);
  CHECK_FALSE(usual.goes_back);
  CHECK(usual.color == 0x19'19'19);
  const policy::Panel large =
      panel_of(R"(, "size": "8x8", "zigzag": true, "color": "orange", "brightness": 20)");
  CHECK(large.side == 8);
  CHECK(large.goes_back);
  CHECK(large.color == 0x33'10'00);
  CHECK(panel_of(R"(, "color": "orange", "brightness": 1)").color == 0x02'01'00);
}

TEST_CASE("ws2812: it is dark until a picture comes, and told what changes alone") {
  Shown robot("SHOW face happy\nTHEN\nSHOW face happy\nTHEN\nWAIT 100ms\nSTOP face");
  CHECK(robot.told() == Pictures{0, happy()});
  robot.pass(100 + 2 * policy::kLeastPauseMs + test::kPanelTold);
  CHECK(robot.told() == Pictures{0, happy(), 0});
  robot.pass(1000);
  CHECK(robot.told() == Pictures{0, happy(), 0});
}

TEST_CASE("ws2812: with FOR a picture goes; BLINK closes and opens") {
  Shown goes("SHOW face happy FOR 300ms");
  goes.pass(300 + test::kPanelTold);
  CHECK(goes.told() == Pictures{0, happy(), 0});
  Shown blinks("SHOW face happy\nWAIT 100ms\nBLINK face 2 TIMES OVER 800ms");
  blinks.pass(2000);
  CHECK(blinks.told() == Pictures{0, happy(), 0, happy(), 0, happy()});
}

TEST_CASE("ws2812: a picture has its time; of those that come meanwhile only the last one counts") {
  kernel::Kernel kernel;
  test::NotingBoard board;
  guard::OutputGuard outputs(kernel, board);
  const auto wiring = test::servo_and(vm::DriverId::ws2812_face, vm::Release::rest);
  vm::Image image;
  image.actuators = wiring;
  outputs.own(image);
  const auto at = [&](unsigned milliseconds) {
    outputs.go_on(kernel::milliseconds(milliseconds));
    return board.noting_panel.pictures;
  };
  outputs.show(1, 5);
  CHECK(at(policy::kPanelGapMs - 1).empty());
  CHECK(at(policy::kPanelGapMs) == Pictures{5});
  outputs.show(1, 6);
  CHECK(at(policy::kPanelGapMs + 1) == Pictures{5});
  outputs.show(1, 7);
  CHECK(at(2 * policy::kPanelGapMs) == Pictures{5, 7});
  CHECK(at(3 * policy::kPanelGapMs) == Pictures{5, 7});
}

TEST_CASE(
    "ws2812: a halt is dark, unless the safe state is to hold; nothing shows until it is over") {
  for (const bool holds : {false, true})
    for (const bool person : {false, true}) {
      Shown robot("SHOW face happy", holds ? R"(, "safe": "hold")" : "");
      CHECK(robot.now() == happy());
      if (person)
        robot.rig.runtime.stop();
      else
        robot.rig.feed(0, 95);
      robot.pass(test::kPanelTold);
      CHECK(robot.now() == (holds ? happy() : 0));
      robot.pass(500);
      CHECK(robot.now() == (holds ? happy() : 0));
      if (person) robot.rig.runtime.resume();
      robot.rig.feed(0, 0);
      robot.pass(100);
      CHECK(robot.now() == (holds ? happy() : 0));
      robot.rig.feed(0, 20);
      robot.pass(test::kPanelTold);
      CHECK(robot.now() == happy());
    }
}

TEST_CASE("ws2812: the next program, and no program, begin in the dark") {
  Shown robot("SHOW face happy");
  REQUIRE(
      robot.rig
          .activate(test::compile("WHEN near X > 10\nDO\nMOVE arm TO 10deg\nEND\n", with_panel()))
          .ok());
  CHECK(robot.told() == Pictures{0, happy(), 0});
  Shown cleared("SHOW face happy");
  cleared.rig.runtime.clear();
  CHECK(cleared.told() == Pictures{0, happy(), 0});
  Shown again("SHOW face happy");
  REQUIRE(
      again.rig.activate(test::compile("WHEN near X > 90\nDO\nSHOW face sad\nEND\n", with_panel()))
          .ok());
  again.pass(test::kPanelTold);
  CHECK(again.told() == Pictures{0, happy(), 0});
}

TEST_CASE(
    "ws2812: its pin is given back to a program that has something else there, and only then") {
  kernel::Kernel kernel;
  test::NotingBoard board;
  guard::OutputGuard outputs(kernel, board);
  const auto program = [](vm::DriverId driver, std::uint16_t pin) {
    auto wiring = test::servo_and(driver, vm::Release::rest);
    wiring[1].pin = pin;
    return wiring;
  };
  const auto own = [&](const std::array<vm::Actuator, 2>& wiring,
                       std::span<const vm::Sensor> sensors = {}) {
    vm::Image image;
    image.actuators = wiring;
    image.sensors = sensors;
    outputs.own(image);
    return board.noting_panel.ends;
  };
  const auto panel = program(vm::DriverId::ws2812_face, 3);
  CHECK(own(panel) == 0);
  CHECK(own(panel) == 0);
  CHECK(own(program(vm::DriverId::servo, 4)) == 0);
  CHECK(own(program(vm::DriverId::servo, 3)) == 1);  // although the panel's program came before
  CHECK(own(program(vm::DriverId::servo, 3)) == 1);
  CHECK(own(panel) == 1);
  outputs.disown();
  auto motor = program(vm::DriverId::motor, 4);
  motor[1].bus = 3;
  CHECK(own(motor) == 2);
  std::array<vm::Sensor, 1> sonar{};
  sonar[0].driver = vm::DriverId::hc_sr04;
  sonar[0].bus = 3;
  CHECK(own(panel) == 2);
  CHECK(own(program(vm::DriverId::servo, 4), sonar) == 3);
  sonar[0].driver = vm::DriverId::analog_input;
  sonar[0].address = 3;
  CHECK(own(panel) == 3);
  CHECK(own(program(vm::DriverId::servo, 4), sonar) == 4);
}

TEST_CASE("ws2812: the guard shows nothing for whom it has halted, nor for who has no panel") {
  kernel::Kernel kernel;
  test::NotingBoard board;
  guard::OutputGuard outputs(kernel, board);
  const auto wiring = test::servo_and(vm::DriverId::ws2812_face, vm::Release::rest);
  vm::Image image;
  image.actuators = wiring;
  kernel::Time now = 0;
  const auto told = [&] {
    outputs.go_on(now += kernel::milliseconds(policy::kPanelGapMs));
    return board.noting_panel.pictures;
  };
  outputs.show(1, 7);  // no program owns it yet
  CHECK(told().empty());
  outputs.own(image);
  CHECK(told() == Pictures{0});
  outputs.show(0, 7);
  CHECK(told() == Pictures{0});
  outputs.show(1, 7);
  outputs.halt(0b10);  // before the command was sent
  CHECK(told() == Pictures{0, 0});
  outputs.show(1, 7);
  CHECK(told() == Pictures{0, 0});
  outputs.let_go(0b10);
  outputs.show(1, 5);
  CHECK(told() == Pictures{0, 0, 5});
  outputs.disown();
  CHECK(board.noting_panel.pictures == Pictures{0, 0, 5, 0});
  outputs.show(1, 5);
  CHECK(told() == Pictures{0, 0, 5, 0});
}

TEST_CASE(
    "ws2812: a second panel, a shared pin, too much light and a pin without one are refused") {
  const auto judged = [](auto change, bool has_pins = true) {
    std::vector<std::byte> bytes = test::compile(
        "WHEN near X > 10\nDO\nSHOW face happy\nMOVE arm TO 10deg\nEND\n", with_panel());
    vm::Image image;
    REQUIRE(vm::view_image(bytes, image));
    for (const vm::Actuator& actuator : image.actuators)
      change(const_cast<vm::Actuator&>(actuator));
    vm::test::repair_crc(bytes);
    test::Rig rig;
    if (!has_pins) rig.board.board_pins.panels = {};
    return rig.activate(bytes).refusal;
  };
  const auto panel = [&](auto change) {
    return judged([&](vm::Actuator& actuator) {
      if (vm::drives_panel(actuator.driver)) change(actuator);
    });
  };
  CHECK(judged([](vm::Actuator&) {}) == vm::Refusal::none);
  CHECK(judged([](vm::Actuator&) {}, false) == vm::Refusal::no_pin);
  CHECK(judged([](vm::Actuator& actuator) {
          actuator.driver = vm::DriverId::ws2812_face;
          actuator.bus = 0;
          actuator.speed_limit = 0;
        }) == vm::Refusal::shared_pin);
  CHECK(panel([](vm::Actuator& face) { face.pin = 0; }) == vm::Refusal::shared_pin);
  CHECK(panel([](vm::Actuator& face) { face.bus = 3; }) == vm::Refusal::none);
  CHECK(panel([](vm::Actuator& face) { face.bus = 4; }) == vm::Refusal::bad_value);
  CHECK(panel([](vm::Actuator& face) { face.speed_limit = 0x33'33'33; }) == vm::Refusal::none);
  for (const vm::Value color : {0x34'00'00, 0x00'34'00, 0x00'00'34, 0x01'00'00'00, -1})
    CHECK(panel([&](vm::Actuator& face) { face.speed_limit = color; }) == vm::Refusal::bad_value);
}

}  // namespace ws2812_test
