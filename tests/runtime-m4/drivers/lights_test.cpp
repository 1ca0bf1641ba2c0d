// Lights: pictures, how long they stay, and that they are dark whenever nothing may be shown.
#include <set>

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "runtime-m4/drivers/pictures.hpp"
#include "runtime-m4/guard/output_guard.hpp"
#include "tests/runtime-m4/rig.hpp"
#include "tests/runtime-m4/robot.hpp"
#include "tests/support/golden.hpp"
#include "tests/vm/image_builder.hpp"

using namespace robosync;
using test::Rig;

namespace {

// From the top left, as drivers/pictures.def draws them.
constexpr std::uint32_t picture(std::string_view signs) {
  std::uint32_t lights = 0;
  for (std::size_t i = 0; i < signs.size(); ++i)
    lights |= std::uint32_t{signs[i] == '#'} << i;
  return lights;
}
constexpr std::uint32_t kHappy = picture(
    "....."
    ".#.#."
    "....."
    "#...#"
    ".###.");

std::string with_lights(const std::string& more = "") {
  return R"({"board": "microbit-v2",
             "sensors": [{"name": "near", "type": "VIRTUAL", "channels": {"X": {"range": [0, 100]}}}],
             "actuators": [{"name": "face", "device": "lights")" +
         more + "}]}";
}

struct Lit {
  explicit Lit(const std::string& body, const std::string& more = "") {
    const std::string rsl = test::stops_when_far(body);
    REQUIRE(activate(test::compile(rsl, with_lights(more))).ok());
    feed(0, 6);
    run(10);
    feed(0, 20);
    run(40);
  }
  vm::Verdict activate(const std::vector<std::byte>& bytes) { return rig.activate(bytes); }
  void feed(std::uint8_t channel, int units) { rig.feed(channel, units); }
  void run(std::uint64_t until_ms) { rig.run(until_ms); }
  const std::vector<std::uint32_t>& pictures() const { return rig.board.pictures; }
  std::uint32_t now() const { return pictures().empty() ? 0 : pictures().back(); }

  Rig rig;
};

}  // namespace

TEST_CASE("lights: each word has its picture, and happy is the one that is drawn") {
  const auto descriptor = nlohmann::json::parse(testing::read_file(
      std::filesystem::path(ROBOSYNC_SOURCE_DIR) / "stdlib/devices/matrix.json"));
  const auto face = nlohmann::json::parse(
      testing::read_file(std::filesystem::path(ROBOSYNC_SOURCE_DIR) / "stdlib/devices/face.json"));
  std::set<std::uint32_t> seen;
  for (const auto& [word, settings] : descriptor.at("words").items()) {
    Lit lit("SHOW face " + word);
    CHECK(lit.now() != 0);
    seen.insert(lit.now());
    if (face.at("words").contains(word)) CHECK(face.at("words").at(word) == settings);
  }
  CHECK(seen.size() == descriptor.at("words").size() - 1);  // smile is happy
  for (const auto& [word, settings] : face.at("words").items())
    CHECK(descriptor.at("words").contains(word));
  CHECK(Lit("SHOW face happy").now() == kHappy);
}

TEST_CASE("lights: numbers from 0 to 99, rounded; others show the nearest one") {
  constexpr std::uint32_t kSeven = picture(
      ".###."
      "...#."
      "..#.."
      "..#.."
      "..#..");
  constexpr std::uint32_t kFortyTwo = picture(
      "#..##"
      "#...#"
      "##.##"
      ".#.#."
      ".#.##");
  CHECK(Lit("SHOW face 7").now() == kSeven);
  CHECK(Lit("SHOW face TO (near X - 13.4)").now() == kSeven);  // 20 - 13.4
  CHECK(Lit("SHOW face 42").now() == kFortyTwo);
  CHECK(Lit("SHOW face TO (near X * 2.1)").now() == kFortyTwo);
  CHECK(Lit("SHOW face TO (near X * 100)").now() == Lit("SHOW face 99").now());
  CHECK(Lit("SHOW face TO (0 - near X)").now() == Lit("SHOW face 0").now());
  std::set<std::uint32_t> seen;
  for (vm::Value number = 0; number <= drivers::kMostShown; ++number)
    seen.insert(drivers::number_picture(number * vm::kScale));
  CHECK(seen.size() == 100);
  Lit counts("SHOW face 7 FOR 500ms");
  counts.run(530);
  CHECK(counts.now() == 0);
}

TEST_CASE("lights: the robot's own pictures, one in place of a built-in one") {
  constexpr std::uint32_t kRobot = picture(
      "#...#"
      "#####"
      "#.#.#"
      "#####"
      ".#.#.");
  const auto shown = [](const std::string& name, const std::string& own) {
    const std::string rsl = test::stops_when_far("SHOW face " + name);
    Rig rig;
    const std::string robot = with_lights();
    const auto image = test::compile(
        rsl,
        robot.substr(0, robot.size() - 1) + R"(, "pictures": {")" + own +
            R"(": ["#...#", "#####", "#.#.#", "#####", ".#.#."], "full": ["#####", "#####", "#####", "#####", "#####"]}})");
    REQUIRE(rig.activate(image).ok());
    rig.feed(0, 6);
    rig.run(10);
    rig.feed(0, 20);
    rig.run(20);
    return rig.board.pictures.back();
  };
  CHECK(shown("robot", "robot") == kRobot);
  CHECK(shown("happy", "happy") == kRobot);
  CHECK(shown("happy", "robot") == kHappy);
  CHECK(shown("full", "robot") == vm::kAllLights);
}

TEST_CASE("lights: a picture stays; with FOR it goes, STOP is dark at once") {
  Lit stays("SHOW face happy");
  stays.run(5000);
  CHECK(stays.now() == kHappy);
  Lit goes("SHOW face happy FOR 500ms");
  goes.run(500);
  CHECK(goes.now() == kHappy);
  goes.run(530);
  CHECK(goes.now() == 0);
  CHECK(Lit("SHOW face happy\nTHEN\nSTOP face").now() == 0);
}

TEST_CASE("lights: BLINK closes and opens, so many times in that time") {
  Lit lit("SHOW face happy\nTHEN\nBLINK face 2 TIMES OVER 800ms");
  lit.run(3000);
  CHECK(lit.pictures() == std::vector<std::uint32_t>{kHappy, 0, kHappy, 0, kHappy});
  CHECK(lit.rig.only("done") == "10 #2 done face\n830 #3 done face\n");
}

TEST_CASE(
    "lights: a halt is dark at once, unless the safe state is to hold; nothing shows until it is "
    "over") {
  for (const bool holds : {false, true}) {
    Lit lit("SHOW face happy", holds ? R"(, "safe": "hold")" : "");
    lit.feed(0, 95);
    lit.run(40);
    CHECK(lit.now() == (holds ? kHappy : 0));
    lit.feed(0, 0);
    lit.run(60);
    lit.feed(0, 20);
    lit.run(80);
    CHECK(lit.now() == kHappy);
    lit.rig.runtime.stop();
    lit.run(100);
    CHECK(lit.now() == (holds ? kHappy : 0));
  }
}

TEST_CASE("lights: the next program, and no program, begin in the dark") {
  Lit lit("SHOW face happy");
  REQUIRE(lit.now() == kHappy);
  REQUIRE(lit.activate(test::compile("WHEN near X > 10\nDO LOG \"x\"\nEND\n", with_lights())).ok());
  CHECK(lit.now() == 0);
  Lit cleared("SHOW face happy");
  cleared.rig.runtime.clear();
  CHECK(cleared.now() == 0);
}

TEST_CASE("lights: two actuators that have them are refused") {
  std::vector<std::byte> bytes =
      test::compile("WHEN near X > 10\nDO\nSHOW face happy\nMOVE arm TO 10deg\nEND\n",
                    R"({"board": "microbit-v2",
          "sensors": [{"name": "near", "type": "VIRTUAL", "channels": {"X": {"range": [0, 100]}}}],
          "actuators": [{"name": "face", "device": "lights"},
                        {"name": "arm", "type": "PWM", "pin": 0, "device": "servo"}]})");
  vm::Image image;
  REQUIRE(vm::view_image(bytes, image));
  for (const vm::Actuator& actuator : image.actuators)
    const_cast<vm::Actuator&>(actuator).driver = vm::DriverId::lights;
  vm::test::repair_crc(bytes);
  CHECK(Rig().activate(bytes).refusal == vm::Refusal::shared_pin);
}

TEST_CASE("lights: the guard shows nothing for whom it has halted, nor for who has no lights") {
  kernel::Kernel kernel;
  test::NotingBoard board;
  guard::OutputGuard outputs(kernel, board);
  const auto wiring = test::servo_and(vm::DriverId::lights, vm::Release::rest);
  vm::Image image;
  image.actuators = wiring;
  outputs.show(1, 7);  // no program owns them yet
  outputs.own(image);
  outputs.show(0, 7);
  CHECK(board.pictures.empty());
  outputs.show(1, 7);
  outputs.halt(0b10);
  outputs.show(1, 7);
  CHECK(board.pictures == std::vector<std::uint32_t>{7, 0});
  outputs.let_go(0b10);
  outputs.show(1, 5);
  outputs.disown();
  outputs.show(1, 5);
  CHECK(board.pictures == std::vector<std::uint32_t>{7, 0, 5, 0});
}
