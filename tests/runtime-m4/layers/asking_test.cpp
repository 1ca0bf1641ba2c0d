// Sensors on a bus that works in the background: they are asked a millisecond before they are sampled, and waited for a bounded
// time.
#include <catch2/catch.hpp>

#include "tests/runtime-m4/rig.hpp"
#include "tests/runtime-m4/robot.hpp"

using namespace robosync;

namespace {

const char* const kAskedRobot = R"({"sensors": [
  {"name": "a", "type": "I2C", "address": "0x21", "device": "i2c_register",
   "channels": {"P": {"input": 1, "rate": "50Hz"}, "Q": {"input": 2, "rate": "50Hz"}}}]})";
const char* const kAskingProgram = R"(
WHEN a P > 500 DO LOG "p" END
WHEN a Q > 500 DO LOG "q" END
)";

struct Asked {
  std::uint64_t at_ms;
  bool ahead;
  int input;
  bool operator==(const Asked&) const = default;
};

struct AskingRig {
  AskingRig() {
    rig.board.asks_ahead = 1;
    rig.board.on_transfer = [this](std::span<const std::byte> out, std::span<std::byte> in) {
      asked.push_back(
          {rig.kernel.now() / 1000, rig.board.asked_ahead, std::to_integer<int>(out.front())});
      if (rig.board.asked_ahead) return false;
      for (std::byte& byte : in)
        byte = std::byte{3};  // 0x0303
      return true;
    };
  }
  void run(std::uint64_t until_ms) {
    if (asked.empty()) REQUIRE(rig.activate(test::compile(kAskingProgram, kAskedRobot)).ok());
    rig.run(until_ms);
  }
  test::Rig rig;
  std::vector<Asked> asked;
};

}  // namespace

TEST_CASE(
    "a sensor that is asked ahead: all its channels, one tick before, then sampled when due") {
  AskingRig robot;
  robot.run(45);
  // The program begins at 0, so the first sample is not asked ahead.
  CHECK(robot.asked == std::vector<Asked>{{0, true, 1},
                                          {0, true, 2},
                                          {0, false, 1},
                                          {0, false, 2},
                                          {19, true, 1},
                                          {19, true, 2},
                                          {20, false, 1},
                                          {20, false, 2},
                                          {39, true, 1},
                                          {39, true, 2},
                                          {40, false, 1},
                                          {40, false, 2}});
  CHECK(robot.rig.only("log").find("p") != std::string::npos);
}

TEST_CASE("a sensor that is asked ahead: who has answers late is waited for, two ticks at most") {
  for (const unsigned late : {0U, 1U, 2U, 3U, 100U}) {
    AskingRig robot;
    robot.rig.board.busy = [&] { return robot.rig.kernel.now() / 1000 < 20 + late; };
    robot.run(30);
    const Asked sampled = robot.asked.back();
    CHECK_FALSE(sampled.ahead);
    CHECK(sampled.at_ms == 20 + std::min(late, 2U));
    robot.run(50);
    CHECK(robot.asked.back().at_ms >= 40);  // its next turn is not shifted
    CHECK(robot.asked.back().at_ms <= 42);
  }
}

TEST_CASE("a sensor on a bus that does not work by itself is asked when it is due, and only then") {
  AskingRig robot;
  robot.rig.board.asks_ahead = 0;
  robot.run(25);
  CHECK(robot.asked ==
        std::vector<Asked>{{0, false, 1}, {0, false, 2}, {20, false, 1}, {20, false, 2}});
}
