// A strip of WS2812 lights: which colour the board is told to show, and when. tests/runtime-m4/boards/panel_test.cpp tests a
// board's output, ws2812_test.cpp what a strip has in common with a panel.
#include <string>
#include <vector>

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "runtime-m4/guard/output_guard.hpp"
#include "tests/runtime-m4/drivers/panel_robot.hpp"
#include "tests/support/golden.hpp"

using namespace robosync;

namespace ws2812_strip_test {
namespace {

using Colors = std::vector<std::uint32_t>;
constexpr std::uint32_t kRed = 0x19'00'00, kBlue = 0x00'00'19, kWhite = 0x19'19'19;

struct Lit : test::PanelRobot {
  explicit Lit(const std::string& body, const std::string& more = "")
      : PanelRobot(body,
                   R"({"board": "microbit-v2",
                "sensors": [{"name": "near", "type": "VIRTUAL", "channels": {"X": {"range": [0, 100]}}}],
                "actuators": [{"name": "eyes", "pin": 1, "device": "ws2812_strip", "lights": 8)" +
                       more +
                       R"(}, {"name": "arm", "type": "PWM", "pin": 0, "device": "servo"}]})") {}
};

}  // namespace

TEST_CASE("ws2812_strip: the board has what robot.json says of the strip") {
  const Lit robot("LIGHT eyes");
  REQUIRE(robot.rig.board.noting_panel.begun.size() == 1);
  const policy::Panel strip = robot.rig.board.noting_panel.begun.front();
  CHECK(strip.pin == 1);
  CHECK(strip.lights() == 8);
  CHECK(robot.told() == Colors{0, kWhite});
  CHECK(Lit("LIGHT eyes", R"(, "brightness": 20)").now() == 0x33'33'33);
}

TEST_CASE("ws2812_strip: its words are the colours, in their order") {
  const auto words = nlohmann::json::parse(testing::read_file(
      std::filesystem::path(ROBOSYNC_SOURCE_DIR) / "stdlib/devices/ws2812_strip.json"))["words"];
  unsigned item = 0;
  const auto check = [&](const std::string& name, std::uint32_t red, std::uint32_t green,
                         std::uint32_t blue) {
    CAPTURE(name);
    CHECK(words.at(name).at("item") == item++);
    const auto at_a_tenth = [](std::uint32_t part) { return part * 25 / 255; };
    CHECK(Lit("LIGHT eyes " + name).now() ==
          (at_a_tenth(red) << 16 | at_a_tenth(green) << 8 | at_a_tenth(blue)));
  };
#define COLOR(name, red, green, blue) check(#name, red, green, blue);
#include "vm/colors.def"
#undef COLOR
  CHECK(words.size() == item + 3);  // and ON, OFF, DIMLY
}

TEST_CASE(
    "ws2812_strip: the colour stays until another is named, and the brightness is that of TO") {
  CHECK(Lit("LIGHT eyes red\nTHEN\nLIGHT eyes DIMLY").now() == 0x05'00'00);
  CHECK(Lit("LIGHT eyes blue TO 0%\nTHEN\nLIGHT eyes").now() == kBlue);
  CHECK(Lit("LIGHT eyes blue OFF").now() == 0);
  // A part of a colour that is dim does not go out before the others.
  CHECK(Lit("LIGHT eyes orange TO 1%").now() == 0x01'01'00);
  CHECK(Lit("LIGHT eyes orange\nTHEN\nSTOP eyes").now() == 0);
}

TEST_CASE("ws2812_strip: OVER fades, and FOR ends") {
  Lit fades("LIGHT eyes TO 100% red OVER 1s");
  std::uint32_t before = fades.now();
  for (unsigned passed = test::kPanelTold; passed < 1000; passed += 20) {
    fades.pass(20);
    CHECK(fades.now() >= before);
    CHECK((fades.now() & 0x00'FF'FF) == 0);
    const std::uint32_t wanted = 25 * passed / 1000;
    CHECK((fades.now() >> 16) <= wanted + 2);
    CHECK((fades.now() >> 16) + 2 >= wanted);
    before = fades.now();
  }
  fades.pass(100);
  CHECK(fades.now() == kRed);
  Lit ends("LIGHT eyes red FOR 300ms");
  ends.pass(270);
  CHECK(ends.now() == kRed);
  ends.pass(40);
  CHECK(ends.told() == Colors{0, kRed, 0});
}

TEST_CASE("ws2812_strip: BLINK flashes, and leaves it as it was") {
  Lit dark("BLINK eyes blue 2 TIMES OVER 800ms");
  dark.pass(2000);
  CHECK(dark.told() == Colors{0, kBlue, 0, kBlue, 0});
  Lit lit("LIGHT eyes red DIMLY\nWAIT 100ms\nBLINK eyes blue 2 TIMES\nTHEN\nWAIT 1s\nBLINK eyes");
  lit.pass(3000);
  constexpr std::uint32_t kDim = 0x05'00'00, kDimBlue = 0x00'00'05;
  CHECK(lit.told() == Colors{0, kDim, kDimBlue, 0, kDimBlue, 0, kDim, 0, kDim});
}

TEST_CASE("ws2812_strip: interrupted it goes dark, or stays, as on_release says") {
  const auto interrupted = [](const std::string& more) {
    Lit robot("LIGHT eyes red FOR 10s", more);
    CHECK(robot.now() == kRed);
    robot.rig.feed(0, 95);  // the SAFETY rule trips
    robot.pass(30);
    return robot.now();
  };
  CHECK(interrupted("") == 0);
  CHECK(interrupted(R"(, "safe": "hold", "on_release": "hold")") == kRed);
}

TEST_CASE("ws2812_strip: the guard lets no light be brighter than a panel may be") {
  kernel::Kernel kernel;
  test::NotingBoard board;
  guard::OutputGuard outputs(kernel, board);
  const auto wiring = test::servo_and(vm::DriverId::ws2812_strip, vm::Release::rest);
  vm::Image image;
  image.actuators = wiring;
  outputs.own(image);
  outputs.show(1, 0xFF'10'34);
  outputs.go_on(kernel::milliseconds(policy::kPanelGapMs));
  CHECK(board.noting_panel.pictures == Colors{0x33'10'33});
}

}  // namespace ws2812_strip_test
