// Encoders of wheels: from edges to a distance and a speed, what is asked of the board, and an encoder that gives too many edges.
#include "runtime-m4/drivers/encoder.hpp"

#include <array>
#include <cstdlib>
#include <map>

#include <catch2/catch.hpp>

#include "runtime-m4/policy/rules.hpp"
#include "tests/runtime-m4/rig.hpp"
#include "tests/runtime-m4/robot.hpp"

using namespace robosync;
using test::Rig;

namespace {

// 40 edges are a turn of 204.2 mm.
constexpr double kMmOfEdge = 65 * 3.14159265 / 40;
const char* const kTwoWheels = R"({"board": "microbit-v2", "sensors": [
  {"name": "left", "device": "encoder", "pins": [5, 9], "pulses_per_turn": 20, "wheel": "65mm"},
  {"name": "right", "device": "encoder", "pin": 8, "pulses_per_turn": 20, "wheel": "6.5cm",
   "channels": {"SPEED": {"rate": "40Hz"}, "DISTANCE": {"rate": "40Hz"}}}]})";
const char* const kSays = R"(
WHEN left DISTANCE > 20.4cm DO LOG "a turn" END
WHEN left DISTANCE < -1cm DO LOG "back" END
WHEN left SPEED > 10.3cm/s DO LOG "fast" END
WHEN left SPEED < -10.1cm/s DO LOG "fast back" END
WHEN right DISTANCE > 1cm DO LOG "right" END
)";

// A wheel whose edges come at times that the test says.
struct Turning {
  std::int32_t edges = 0;
  std::uint64_t last_us = 0;
  bool begun = false, loses = false;
};

struct Robot {
  explicit Robot(const std::string& program = kSays) {
    static constexpr std::array<policy::PinRange, 1> kAny{{{0, 20}}};
    rig.board.board_pins.inputs = kAny;
    rig.board.board_pins.echoes = kAny;
    rig.board.board_pins.outputs = {};
    rig.board.edges_of = [this](unsigned number, std::uint16_t a, std::uint8_t b, unsigned most,
                                boards::Turned& turned) {
      asked[number] = {a, b, most};
      Turning& wheel = wheels[number];
      const auto ago = static_cast<std::uint32_t>(rig.kernel.now() - wheel.last_us);
      turned = {wheel.begun ? wheel.edges : 0, wheel.begun ? ago : 0, !wheel.begun};
      wheel.begun = true;
      return !wheel.loses;
    };
    REQUIRE(rig.activate(test::compile(program, kTwoWheels)).ok());
  }
  // Turns by an edge each `us`, until then.
  void turn(std::uint64_t until_ms, std::uint64_t us, int by = 1) {
    for (std::uint64_t ms = rig.kernel.now() / 1000 + 1; ms <= until_ms; ++ms) {
      while (next_us <= ms * 1000) {
        wheels[0].edges += by;
        wheels[0].last_us = next_us;
        next_us += us;
      }
      rig.run(ms);
    }
  }
  std::size_t logged(const std::string& text) const {
    std::size_t found = 0;
    for (const std::string& line : rig.lines)
      found += line.find("\"" + text + "\"") == std::string::npos ? 0 : 1;
    return found;
  }
  std::map<unsigned, std::array<unsigned, 3>> asked;
  std::map<unsigned, Turning> wheels;
  std::uint64_t next_us = 0;
  Rig rig;
};

// A driver without a robot.
struct Reader {
  std::int32_t read(std::uint8_t input, std::uint64_t now) {
    std::int32_t raw = -99;
    CHECK(encoders.sample(outputs, sensor, 0, input == first, input, now, raw) == counts);
    return raw;
  }
  Reader() {
    sensor.period_ms = 20;
    board.edges_of = [this](unsigned, std::uint16_t, std::uint8_t, unsigned,
                            boards::Turned& given) {
      ++takes;
      given = turned;
      return counts;
    };
  }
  kernel::Kernel kernel;
  test::NotingBoard board;
  guard::OutputGuard outputs{kernel, board};
  vm::Sensor sensor{};
  boards::Turned turned{};
  drivers::Encoders encoders;
  std::uint8_t first = 0;
  bool counts = true;
  unsigned takes = 0;
};

constexpr std::int32_t kParts = vm::kSpeedParts;

}  // namespace

TEST_CASE("encoder: a turn of the wheel is its circumference, forward and back") {
  Robot robot;
  robot.rig.run(10);
  robot.next_us = 20'000;
  robot.turn(1000, 25'000);  // 40 edges
  robot.rig.run(1100);
  CHECK(robot.logged("a turn") == 1);
  CHECK(robot.logged("right") == 0);
  robot.next_us = 1'120'000;
  robot.turn(2200, 24'000, -1);
  CHECK(robot.logged("back") == 1);
  CHECK(robot.wheels[0].edges * kMmOfEdge < -10);
}

TEST_CASE("encoder: the speed is that between edges, though a sample has less than one") {
  Robot robot;
  robot.rig.run(10);
  robot.next_us = 30'000;
  robot.turn(1000, 50'000);  // 10.21 cm/s
  CHECK(robot.logged("fast") == 0);
  robot.turn(2000, 49'000);  // 10.42 cm/s
  CHECK(robot.logged("fast") == 1);
  robot.turn(3000, 50'000, -1);
  CHECK(robot.logged("fast back") == 1);
}

TEST_CASE("encoder: the board is asked for both, with the edges that a period may have") {
  Robot robot;
  robot.rig.run(100);
  CHECK(robot.asked[0] == std::array<unsigned, 3>{5, 9, policy::most_edges(20)});
  CHECK(robot.asked[1] == std::array<unsigned, 3>{8, vm::kNoSecondPin, policy::most_edges(25)});
}

TEST_CASE("encoder: one that loses edges is unknown, and SAFETY trips") {
  Robot robot("SAFETY blind\n  WHEN left SPEED > 150cm/s\n  DO ALERT \"blind\"\nEND\n");
  robot.rig.run(300);
  CHECK(robot.rig.only("trip").empty());
  robot.wheels[0].loses = true;
  robot.rig.run(600);
  CHECK(robot.rig.only("trip") != "");
  CHECK(robot.rig.only("silent").find("left") != std::string::npos);
}

TEST_CASE("encoder: inputs are edges since the program began, and parts of an edge per second") {
  Reader reader;
  reader.turned = {.edges = 0, .ago = 0, .begun = true};
  CHECK(reader.read(0, 1'000'000) == 0);
  CHECK(reader.read(1, 1'000'000) == 0);
  CHECK(reader.takes == 1);
  reader.turned = {.edges = 3, .ago = 2'000, .begun = false};
  CHECK(reader.read(0, 1'020'000) == 3);
  CHECK(reader.read(1, 1'020'000) == kParts * 3 * 1000 / 518);  // it stood until then
  reader.turned = {.edges = -1, .ago = 12'000, .begun = false};
  CHECK(reader.read(0, 1'040'000) == -1);
  CHECK(reader.read(1, 1'040'000) == -kParts * 4 * 1000 / 10);
  // Without an edge it is slower and slower, and then stands.
  reader.turned.ago = 512'000;
  CHECK(reader.read(0, 1'527'999) == -1);
  CHECK(reader.read(1, 1'527'999) == -kParts * 1000 / 499);
  CHECK(reader.read(0, 1'528'000) == -1);
  CHECK(reader.read(1, 1'528'000) == 0);
  CHECK(reader.read(0, 9'000'000'000) == -1);
  // The next edge tells of a speed of half a second's edge at most, the one after it of the true one.
  reader.turned = {.edges = 0, .ago = 1'000, .begun = false};
  CHECK(reader.read(0, 9'000'020'000) == 0);
  CHECK(reader.read(1, 9'000'020'000) <= kParts * 2);
  reader.turned = {.edges = 2, .ago = 1'000, .begun = false};
  reader.read(0, 9'000'040'000);
  CHECK(reader.read(1, 9'000'040'000) == kParts * 100);
}

TEST_CASE("encoder: nothing is known of edges that were lost, of other inputs, or of a third one") {
  Reader reader;
  reader.counts = false;
  CHECK(reader.read(0, 1000) == -99);
  CHECK(reader.read(1, 1000) == -99);
  reader.counts = true;
  reader.turned = {.edges = 5, .ago = 0, .begun = false};
  CHECK(reader.read(0, 21'000) == 5);
  std::int32_t raw = 0;
  CHECK_FALSE(reader.encoders.sample(reader.outputs, reader.sensor, 0, false, 2, 21'000, raw));
  CHECK_FALSE(reader.encoders.sample(reader.outputs, reader.sensor, vm::kMaxEncoders, true, 0,
                                     21'000, raw));
  CHECK(reader.takes == 3 - 1);
}

TEST_CASE("encoder: a pin that can be an output is let go, and the next program counts from 0") {
  Rig rig;
  static constexpr std::array<policy::PinRange, 2> kInputs{{{5, 5}, {0, 2}}};
  static constexpr std::array<policy::PinRange, 1> kCounted{{{5, 5}}};
  static constexpr std::array<policy::PinLimit, 1> kOutputs{{{0, 2, 0, 20'000, 0}}};
  rig.board.board_pins.inputs = kInputs;
  rig.board.board_pins.echoes = kCounted;
  rig.board.board_pins.outputs = kOutputs;
  rig.board.edges_of = [](unsigned, std::uint16_t, std::uint8_t, unsigned, boards::Turned&) {
    return true;
  };
  const auto program =
      test::compile("WHEN it DISTANCE > 1cm DO LOG \"x\" END", R"({"board": "microbit-v2",
    "sensors": [{"name": "it", "device": "encoder", "pins": [5, 1], "pulses_per_turn": 20, "wheel": "65mm"}]})");
  REQUIRE(rig.activate(program).ok());
  REQUIRE(rig.board.handed == std::vector<std::pair<std::uint16_t, bool>>{{1, true}});
  CHECK(rig.board.read[1] == boards::Reads::level);
  rig.run(50);
  rig.board.ended_edges.clear();
  REQUIRE(
      rig.activate(test::compile("AT START DO LOG \"x\" END", R"({"board": "microbit-v2"})")).ok());
  CHECK(rig.board.handed.back() == std::pair<std::uint16_t, bool>{1, false});
  CHECK(rig.board.ended_edges == std::vector<unsigned>{0, 1});
}
