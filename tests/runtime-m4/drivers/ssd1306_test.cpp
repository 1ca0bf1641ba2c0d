// A face on an SSD1306, with a model of it: which of its dots are lit, whatever the bus, the display and the program do.
#include <memory>
#include <random>
#include <set>

#include <catch2/catch.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "tests/runtime-m4/drivers/ssd1306_model.hpp"
#include "tests/runtime-m4/rig.hpp"
#include "tests/runtime-m4/robot.hpp"
#include "tests/support/golden.hpp"
#include "tests/vm/image_builder.hpp"

using namespace robosync;

namespace ssd1306_test {
namespace {

// The place of a picture, and the size of a light in it.
constexpr unsigned kLeft = 36, kTop = 0, kSide = 12, kLights = 5;
constexpr std::uint64_t kFirst = 700;   // ms until everything has been drawn once
constexpr std::uint64_t kChange = 300;  // ms, the most for any change of the picture
constexpr std::uint64_t kRound = 5100;  // ms until everything has been sent again

using Drawing = std::array<std::string_view, kLights>;
constexpr Drawing kDark = {".....", ".....", ".....", ".....", "....."};

const std::map<std::string, Drawing> kDrawings = {
#define PICTURE(name, a, b, c, d, e) {#name, {a, b, c, d, e}},
#include "runtime-m4/drivers/pictures.def"
#undef PICTURE
};

bool has(const Drawing& drawing, unsigned x, unsigned y) {
  if (x < kLeft || x >= kLeft + kLights * kSide || y < kTop || y >= kTop + kLights * kSide)
    return false;
  return drawing[(y - kTop) / kSide][(x - kLeft) / kSide] == '#';
}

bool shows(const test::Ssd1306& display, const Drawing& drawing) {
  for (unsigned y = 0; y < test::Ssd1306::kHeight; ++y)
    for (unsigned x = 0; x < test::Ssd1306::kWidth; ++x)
      if (display.lit(x, y) != has(drawing, x, y)) return false;
  return true;
}
bool shows(const test::Ssd1306& display, const std::string& name) {
  return shows(display, kDrawings.at(name));
}

std::string face(const char* name, const std::string& more = "", const char* address = "0x3C") {
  return fmt::format(R"({{"name": "{}", "type": "I2C", "device": "ssd1306", "address": "{}"{}}})",
                     name, address, more);
}

std::string robot_of(const std::string& actuators) {
  return R"({"sensors": [{"name": "near", "type": "VIRTUAL", "channels": {"X": {"range": [0, 100]}}}],
             "actuators": [)" +
         actuators + "]}";
}

const char* const kSafety = R"(
SAFETY far
  WHEN near X > 90
  DO STOP ALL
  RESUME WHEN near X < 5
END
)";

std::string when_near(const std::string& body) {
  return "WHEN near X > 10 AND near X < 90\nDO\n" + body + "\nEND\n" + kSafety;
}

// A rig with displays on its bus 0.
struct DisplayRig {
  explicit DisplayRig(const std::string& body = "SHOW face happy",
                      const std::string& actuators = face("face"), bool works_by_itself = false) {
    add(0x3C);
    rig.board.asks_ahead = works_by_itself ? 1 : 0;
    rig.board.on_bus = [this](std::uint8_t, std::uint8_t address, std::span<const std::byte> out,
                              std::span<std::byte> in) {
      longest = std::max(longest, out.size());
      if (rig.board.asks_ahead != 0 && rig.board.asked_ahead) {
        taken = transfer(address, out, in);
        return in.empty();
      }
      return rig.board.asks_ahead != 0 ? taken : transfer(address, out, in);
    };
    begin(when_near(body), robot_of(actuators));
  }
  test::Ssd1306& add(std::uint8_t address) {
    displays.push_back(std::make_unique<test::Ssd1306>(address));
    return *displays.back();
  }
  bool transfer(std::uint8_t address, std::span<const std::byte> out, std::span<std::byte> in) {
    bool answered = false;
    for (const auto& display : displays)
      answered = display->transfer(address, out, in) || answered;
    return answered;
  }
  void begin(const std::string& rsl, const std::string& json) {
    REQUIRE(rig.activate(test::compile(rsl, json)).ok());
    feed(0);
  }
  void feed(int near) { rig.feed(0, near); }
  void run(std::uint64_t ms) { rig.run(rig.kernel.now() / 1000 + ms); }
  // Makes the rule fire again.
  void order() {
    feed(6);
    run(5);
    feed(20);
  }
  test::Ssd1306& display() { return *displays.front(); }
  bool said(const std::string& text) const {
    return std::ranges::any_of(
        rig.lines, [&](const std::string& line) { return line.find(text) != std::string::npos; });
  }

  test::Rig rig;
  std::vector<std::unique_ptr<test::Ssd1306>> displays;
  bool taken = false;
  std::size_t longest = 0;
};

}  // namespace

TEST_CASE("ssd1306: out of noise it is set up, and dark until a picture is shown") {
  for (const bool works_by_itself : {false, true}) {
    DisplayRig robot("SHOW face happy", face("face"), works_by_itself);
    for (std::uint64_t ms = 0; ms < kFirst; ms += 10) {
      CHECK(robot.display().dark());  // the old contents are not visible
      robot.run(10);
    }
    CHECK(robot.display().is_on());
    robot.order();
    robot.run(kChange);
    CHECK(shows(robot.display(), "happy"));
    CHECK_FALSE(robot.display().unknown);
  }
}

TEST_CASE("ssd1306: its words are those of a matrix, and each has the same picture") {
  const auto words = [](const char* device) {
    return nlohmann::json::parse(testing::read_file(std::filesystem::path(ROBOSYNC_SOURCE_DIR) /
                                                    "stdlib/devices" / device))
        .at("words");
  };
  CHECK(words("ssd1306.json") == words("matrix.json"));
  for (const auto& [name, drawing] : kDrawings) {
    INFO(name);
    DisplayRig robot("SHOW face " + name);
    robot.run(kFirst);
    robot.order();
    robot.run(kChange);
    CHECK(shows(robot.display(), drawing));
  }
}

TEST_CASE("ssd1306: the trace is that of the lights of a board") {
  const std::string rsl = when_near(
      "SHOW face happy FOR 300ms\nTHEN\nSHOW face sad\nTHEN\nBLINK face 2 TIMES OVER 800ms");
  const auto trace = [&](const std::string& json) {
    test::Robot robot(rsl, json);
    robot.feed(0, "X", 0);
    robot.feed(700, "X", 20);
    robot.feed(900, "X", 95);
    robot.feed(1200, "X", 0);
    robot.feed(1300, "X", 30);
    robot.run(4000);
    return robot.trace();
  };
  const std::string lights =
      R"({"board": "microbit-v2",
          "sensors": [{"name": "near", "type": "VIRTUAL", "channels": {"X": {"range": [0, 100]}}}],
          "actuators": [{"name": "face", "device": "lights"}]})";
  const std::string mine = trace(robot_of(face("face")));
  CHECK(mine == trace(lights));
  CHECK(mine.find("done face") != std::string::npos);
}

TEST_CASE("ssd1306: SHOW stays, with FOR it goes; BLINK closes and opens") {
  DisplayRig robot("SHOW face sad FOR 1000ms");
  robot.run(kFirst);
  robot.order();
  robot.run(900);
  CHECK(shows(robot.display(), "sad"));
  robot.run(100 + kChange);
  CHECK(robot.display().dark());
  CHECK(robot.display().is_on());

  DisplayRig blinks("SHOW face sad\nTHEN\nBLINK face 1 TIMES OVER 2000ms");
  blinks.run(kFirst);
  blinks.order();
  blinks.run(900);
  CHECK(blinks.display().dark());
  blinks.run(2000);
  CHECK(shows(blinks.display(), "sad"));
}

TEST_CASE(
    "ssd1306: what has changed goes out in portions, and nothing else but a little at a time") {
  DisplayRig robot("SHOW face happy\nWAIT 1s\nSHOW face sad");
  robot.run(kFirst);
  robot.order();
  robot.run(kChange);
  auto& display = robot.display();
  display.transfers = 0;
  robot.run(500);
  CHECK(display.transfers >= 9);  // a disconnected wire is noticed
  CHECK(display.transfers <= 11);
  display.transfers = 0;
  robot.run(200 + kChange);
  CHECK(shows(display, "sad"));
  CHECK(display.transfers < 60);
  CHECK(robot.longest <= 19);  // others on the bus wait for this
}

TEST_CASE(
    "ssd1306: a halt is dark, unless the safe state is to hold; nothing shows until it is over") {
  for (const bool holds : {false, true}) {
    DisplayRig robot("SHOW face happy", face("face", holds ? R"(, "safe": "hold")" : ""));
    robot.run(kFirst);
    robot.order();
    robot.run(kChange);
    REQUIRE(shows(robot.display(), "happy"));
    robot.feed(95);
    robot.run(kChange);
    CHECK(shows(robot.display(), holds ? kDrawings.at("happy") : kDark));
    robot.feed(0);
    robot.run(kChange);
    CHECK(shows(robot.display(), holds ? kDrawings.at("happy") : kDark));  // it stays off
    robot.order();
    robot.run(kChange);
    CHECK(shows(robot.display(), "happy"));
    robot.rig.runtime.stop();
    robot.rig.run(robot.rig.kernel.now() / 1000);
    robot.rig.runtime.resume();  // before the display's driver has noticed
    robot.run(kChange);
    CHECK(shows(robot.display(), holds ? kDrawings.at("happy") : kDark));
    robot.rig.runtime.stop();
    robot.order();
    robot.run(kChange);
    CHECK(shows(robot.display(), holds ? kDrawings.at("happy") : kDark));
  }
}

TEST_CASE("ssd1306: two of them show each its own") {
  DisplayRig robot("SHOW left happy\nSHOW right sad",
                   face("left", "", "0x3C") + "," + face("right", "", "0x3D"));
  test::Ssd1306& second = robot.add(0x3D);
  robot.run(1000);
  robot.order();
  robot.run(kChange);
  CHECK(shows(robot.display(), "happy"));
  CHECK(shows(second, "sad"));
}

TEST_CASE("ssd1306: one that does not answer is told of, holds nothing up, and comes back") {
  for (const bool works_by_itself : {false, true}) {
    DisplayRig robot("SHOW face happy\nTHEN\nLOG \"goes on\"", face("face"), works_by_itself);
    robot.display().absent = true;
    robot.run(1000);
    CHECK(robot.said("silent"));
    robot.order();
    robot.run(20);
    CHECK(robot.said("goes on"));
    CHECK_FALSE(robot.said("deadline"));
    CHECK_FALSE(robot.said("answers"));
    robot.display().absent = false;
    robot.display().lose_power();
    robot.run(kFirst + kChange);
    CHECK(robot.said("answers"));
    CHECK(shows(robot.display(), "happy"));
  }
}

TEST_CASE("ssd1306: a wire that comes off in the midst of a picture") {
  DisplayRig robot;
  robot.run(kFirst);
  robot.order();
  robot.run(60);
  robot.display().absent = true;
  robot.run(500);
  CHECK(robot.said("silent"));
  robot.display().absent = false;
  robot.run(kFirst + kChange);
  CHECK(shows(robot.display(), "happy"));
}

TEST_CASE("ssd1306: a byte that is disturbed in each transfer is not for ever") {
  for (std::size_t byte = 1; byte <= 19; ++byte) {
    DisplayRig robot;
    robot.run(kFirst);
    robot.order();
    robot.display().disturbed_byte = byte;
    robot.run(500);
    robot.display().disturbed_byte = 0;
    robot.run(2 * kFirst);
    CHECK(shows(robot.display(), "happy"));
  }
}

TEST_CASE("ssd1306: one that lost its power unnoticed is right again after a round") {
  DisplayRig robot;
  robot.run(kFirst);
  robot.order();
  robot.run(kChange);
  robot.display().lose_power();
  robot.run(kRound);
  CHECK(shows(robot.display(), "happy"));
  CHECK_FALSE(robot.said("silent"));
}

TEST_CASE("ssd1306: whatever another program has told it is said otherwise") {
  const std::initializer_list<std::uint8_t> told[] = {{0x20, 0x00, 0x21, 10, 20, 0x22, 3, 4, 0xAF},
                                                      {0x20, 0x01},
                                                      {0xA0, 0xC0},
                                                      {0xA5},
                                                      {0xA7},
                                                      {0xA8, 0x1F},
                                                      {0xD3, 0x10},
                                                      {0x5F},
                                                      {0xDA, 0x02},
                                                      {0x8D, 0x10},
                                                      {0xAE},
                                                      {0xB5, 0x1F, 0x07},
                                                      {0x81}};  // the last one is incomplete
  for (const auto& before : told) {
    DisplayRig robot;
    robot.display().tell(before);
    robot.run(kFirst);
    robot.order();
    robot.run(kChange);
    if (before.size() == 1 && *before.begin() == 0x81) robot.run(kRound);
    CHECK(shows(robot.display(), "happy"));
  }
}

TEST_CASE("ssd1306: the next program begins anew, in the dark") {
  DisplayRig robot;
  robot.run(kFirst);
  robot.order();
  robot.run(kChange);
  REQUIRE(shows(robot.display(), "happy"));
  robot.begin(when_near("SHOW face sad"), robot_of(face("face")));
  robot.run(kFirst);
  CHECK(robot.display().dark());
}

TEST_CASE("ssd1306: drawn lives") {
  std::mt19937 random(1306);
  for (unsigned life = 0; life < 60; ++life) {
    const auto show = [](const char* word) {
      return fmt::format("WHEN near X > 10 AND near X < {} DO SHOW face {} END\n",
                         word[0] == 'h' ? 30 : 50, word);
    };
    const std::string rsl = show("happy") +
                            "WHEN near X > 40 AND near X < 60 DO SHOW face sad END\n" +
                            "WHEN near X > 60 AND near X < 80 DO BLINK face END\n" + kSafety;
    DisplayRig robot("SHOW face happy", face("face"), life % 3 == 0);
    robot.begin(rsl, robot_of(face("face")));
    bool stopped = false;
    for (unsigned turn = 0; turn < 40; ++turn) {
      const auto what = random() % 8;
      if (what < 3) robot.feed(static_cast<int>(what) * 25 + 20);
      if (what == 3) robot.display().absent = !robot.display().absent;
      if (what == 4) robot.display().lose_power();
      if (what == 5) robot.display().disturbed_byte = random() % 20;
      if (what == 6) {
        stopped = !stopped;
        stopped ? robot.rig.runtime.stop() : robot.rig.runtime.resume();
      }
      if (what == 7) robot.feed(static_cast<int>(random() % 100));
      robot.run(1 + random() % 90);
    }
    if (stopped) robot.rig.runtime.resume();
    robot.display().absent = false;
    robot.display().disturbed_byte = 0;
    robot.feed(0);
    robot.run(kRound + kFirst);
    robot.feed(20);
    robot.run(kChange);
    CHECK(shows(robot.display(), "happy"));
    robot.feed(45);
    robot.run(kChange);
    CHECK(shows(robot.display(), "sad"));
  }
}

// ---- what no image can do

namespace {

using Change = std::function<void(vm::Sensor& one, vm::Sensor& other, vm::Actuator& left,
                                  vm::Actuator& right)>;

vm::Refusal refused(const Change& change) {
  std::vector<std::byte> bytes =
      test::compile(when_near("SHOW left happy\nSHOW right sad"),
                    robot_of(face("left", "", "0x3C") + "," + face("right", "", "0x3D")));
  vm::Image image;
  REQUIRE(vm::view_image(bytes, image));
  REQUIRE(image.sensors.size() == 3);
  const auto at = [](const auto& record) -> auto& {
    return const_cast<std::remove_cvref_t<decltype(record)>&>(record);
  };
  change(at(image.sensors[1]), at(image.sensors[2]), at(image.actuators[0]),
         at(image.actuators[1]));
  vm::test::repair_crc(bytes);
  test::Rig rig;
  return rig.activate(bytes).refusal;
}

}  // namespace

TEST_CASE("ssd1306: an image in which displays are shared, or are none, is refused") {
  using vm::Refusal;
  CHECK(refused([](auto&...) {}) == Refusal::none);
  for (const int address : {0x3B, 0x3E, 0x00, 0x40})
    CHECK(refused([&](auto& one, auto&...) {
            one.address = static_cast<std::uint16_t>(address);
          }) == Refusal::bad_value);
  CHECK(refused([](auto& one, auto& other, auto&...) { one.address = other.address; }) ==
        Refusal::bad_value);
  CHECK(refused([](auto& one, auto&...) { one.period_ms = 20; }) == Refusal::bad_value);
  CHECK(refused([](auto& one, auto&...) { one.period_ms = 0; }) == Refusal::bad_value);
  CHECK(refused([](auto& one, auto&...) { one.first_input = 36; }) == Refusal::bad_value);
  CHECK(refused([](auto& one, auto&...) { one.bus = 3; }) == Refusal::no_bus);
  CHECK(refused([](auto&, auto&, auto& left, auto&) { left.bus = 0; }) == Refusal::bad_index);
  CHECK(refused([](auto&, auto&, auto& left, auto&) { left.bus = 200; }) == Refusal::bad_index);
  CHECK(refused([](auto&, auto&, auto& left, auto& right) { right.bus = left.bus; }) ==
        Refusal::shared_pin);
  // A servo's pulses cannot go to a display, nor a picture to a servo chip.
  CHECK(refused([](auto&, auto&, auto& left, auto&) {
          left.driver = vm::DriverId::pca9685_servo;
          left.pin = 3;
          left.safe = vm::Release::coast;
        }) == Refusal::bad_index);
  CHECK(refused([](auto& one, auto&...) {
          one.driver = vm::DriverId::pca9685;
          one.address = 0x40;
          one.period_ms = vm::kServoFrameMs;
          one.first_input = 36;
        }) == Refusal::bad_index);
}

TEST_CASE("ssd1306: the guard keeps no picture for whom it has halted, nor for others") {
  kernel::Kernel kernel;
  test::NotingBoard board;
  guard::OutputGuard outputs(kernel, board);
  const auto wiring = test::servo_and(vm::DriverId::ssd1306_face, vm::Release::rest);
  std::array<vm::Sensor, 1> sensors{};
  sensors[0].driver = vm::DriverId::ssd1306;
  vm::Image image;
  image.actuators = wiring;
  image.sensors = sensors;
  outputs.show(1, 7);  // no program owns it yet
  outputs.own(image);
  board.writes.clear();
  CHECK(outputs.picture_on(0) == 0);
  outputs.show(0, 7);
  CHECK(outputs.picture_on(0) == 0);
  outputs.show(1, 7);
  CHECK(outputs.picture_on(0) == 7);
  CHECK(outputs.picture_on(1) == 0);
  outputs.halt(0b10);
  CHECK(outputs.picture_on(0) == 0);
  outputs.show(1, 7);
  CHECK(outputs.picture_on(0) == 0);
  outputs.let_go(0b10);
  outputs.show(1, 5);
  CHECK(outputs.picture_on(0) == 5);
  outputs.drive(1, 1500, 0);
  outputs.drive_either(1, -1500, 0);
  outputs.disown();
  CHECK(outputs.picture_on(0) == 0);
  CHECK(board.pictures.empty());
  // Nothing of it is on a pin; the servo's pin goes off with the program.
  CHECK(board.writes == std::vector<std::pair<std::uint16_t, std::uint32_t>>{{7, 0}});
}

}  // namespace ssd1306_test
