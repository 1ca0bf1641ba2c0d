// From readings to steps: which readings are news or unknown, and when a step begins.
#include <catch2/catch.hpp>

#include "tests/runtime-m4/robot.hpp"

using robosync::test::Robot;

namespace {

constexpr const char* kWatchX = "WHEN near X > 10\nDO MOVE a\nEND\n";

// The plain robot with other keys in the channel of `near`; `type` of the sensor as given.
std::string with_channel(const std::string& keys, const std::string& type = R"("VIRTUAL")") {
  return R"({"sensors": [{"name": "near", "type": )" + type + R"(, "channels": {"X": {)" + keys +
         R"(}}}], "actuators": [{"name": "a", "type": "VIRTUAL", "device": "virtual_actuator"}]})";
}

const char* const kSampled = R"("I2C", "bus": 0, "address": "0x70", "device": "max34451")";

}  // namespace

TEST_CASE("the first reading counts as a change, the same value does not") {
  Robot robot(kWatchX);
  robot.feed(5, "X", 11);
  robot.feed(10, "X", 11);
  robot.feed(20, "X", 12);
  robot.run(50);
  CHECK(robot.only("input fire") == "5 #1 input X 11\n5 #1 fire r0 DO\n20 #2 input X 12\n");
}

TEST_CASE("a change smaller than the channel's is not news, but small changes add up") {
  Robot robot(kWatchX, with_channel(R"("range": [0, 100], "change": 5)"));
  int at = 0;
  for (const int value : {50, 54, 46, 55, 58, 60, 51, 50, 45})
    robot.feed(static_cast<std::uint64_t>(++at) * 10, "X", value);
  robot.run(200);
  CHECK(robot.only("input") ==
        "10 #1 input X 50\n40 #2 input X 55\n60 #3 input X 60\n70 #4 input X 51\n"
        "90 #5 input X 45\n");
}

TEST_CASE("readings are clamped to the channel's range") {
  Robot robot(kWatchX, with_channel(R"("range": [-5, 20])"));
  robot.feed(10, "X", 1000);
  robot.feed(20, "X", -1000);
  robot.feed_raw(30, "X", robosync::vm::kValueMax);
  robot.run(100);
  CHECK(robot.only("input") == "10 #1 input X 20\n20 #2 input X -5\n30 #3 input X 20\n");
}

TEST_CASE("everything fed for one tick enters one step") {
  Robot robot("WHEN near X > 10 AND far Y > 10\nDO MOVE a\nEND\n");
  robot.feed(10, "Y", 20);
  robot.feed(10, "X", 20);
  robot.run(100);
  CHECK(robot.only("input fire") == "10 #1 input X 20\n10 #1 input Y 20\n10 #1 fire r0 DO\n");
}

TEST_CASE("an unknown channel: AND and OR know what they can, and no rule acts on an unknown") {
  Robot robot(R"(
WHEN near X > 10 AND far Y > 10
DO MOVE a
ELSE
MOVE b
END
WHEN near X > 10 OR far Y > 10
DO MOVE c
END
)");
  robot.feed(10, "X", 5);   // AND is false whatever Y is; OR is unknown
  robot.feed(20, "X", 20);  // AND is unknown; OR is true
  robot.feed(30, "Y", 20);  // AND is true
  robot.run(100);
  CHECK(robot.only("fire") == "10 #1 fire r0 ELSE\n20 #2 fire r1 DO\n30 #3 fire r0 DO\n");
}

TEST_CASE("a fed channel becomes unknown when no reading comes, and is back with the next") {
  Robot robot(kWatchX, with_channel(R"("range": [0, 100], "stale_after": "200ms")"));
  robot.feed(0, "X", 20);
  robot.feed(150, "X", 20);   // no news, but a sign of life
  robot.feed(1000, "X", 20);  // the same value is news now; the rule still remembers that it held
  robot.feed(1100, "X", 5);
  robot.feed(1200, "X", 20);
  robot.run(1300);
  CHECK(robot.only("input stale fire") ==
        "0 #1 input X 20\n0 #1 fire r0 DO\n351 #2 stale X\n1000 #3 input X 20\n"
        "1100 #4 input X 5\n1200 #5 input X 20\n1200 #5 fire r0 DO\n");
}

TEST_CASE("a sensor that samples does so at its period, counted from activation") {
  Robot robot(kWatchX, with_channel(R"("input": 0, "range": [0, 100], "rate": "50Hz")", kSampled));
  robot.feed(0, "X", 1);
  robot.feed(21, "X", 2);
  robot.feed(39, "X", 3);
  robot.feed(60, "X", 4);
  robot.run(100);
  CHECK(robot.only("input") == "0 #1 input X 1\n40 #2 input X 3\n60 #3 input X 4\n");
}

TEST_CASE("a sensor that samples the same value for long is not stale; one that fails is") {
  Robot robot(
      kWatchX,
      with_channel(R"("input": 0, "range": [0, 100], "rate": "50Hz", "stale_after": "100ms")",
                   kSampled));
  robot.feed(0, "X", 1);
  robot.feed_raw(1000, "X", robosync::vm::kUnknown);  // it no longer answers
  robot.feed(2000, "X", 1);
  robot.run(3000);
  // The last good sample is the one at 980 ms.
  CHECK(robot.only("input stale") == "0 #1 input X 1\n1081 #2 stale X\n2000 #3 input X 1\n");
}

TEST_CASE("a fed unknown is a failed reading and changes nothing") {
  Robot robot(kWatchX);
  robot.feed(10, "X", 20);
  robot.feed_raw(20, "X", robosync::vm::kUnknown);
  robot.run(100);
  CHECK(robot.only("input stale") == "10 #1 input X 20\n");
}

TEST_CASE("more feeds than the board's queue holds, fed in any order") {
  Robot robot(kWatchX);
  std::string expected;
  for (int i = 0; i < 500; ++i) {
    const int at = (i * 7) % 500;  // every tick once
    robot.feed(static_cast<std::uint64_t>(at), "X", at % 100);
  }
  for (int at = 0; at < 500; ++at)
    expected += std::to_string(at) + " #" + std::to_string(at + 1) + " input X " +
                std::to_string(at % 100) + "\n";
  robot.run(1000);
  CHECK(robot.only("input") == expected);
  CHECK(robot.status().steps == 500);
}

TEST_CASE("of two feeds for one channel and tick the last one counts; the past is now") {
  Robot robot(kWatchX);
  robot.feed(10, "X", 1);
  robot.feed(10, "X", 2);
  robot.run(20);
  robot.feed(5, "X", 3);
  robot.run(30);
  CHECK(robot.only("input") == "10 #1 input X 2\n20 #2 input X 3\n");
}

TEST_CASE("running in pieces is running at once") {
  const auto trace = [](std::uint64_t piece) {
    Robot robot("WHEN near X > 10\nDO MOVE a FOR 35ms\nELSE\nMOVE a FOR 15ms\nEND\n");
    for (int i = 0; i < 20; ++i)
      robot.feed(static_cast<std::uint64_t>(i) * 13, "X", i * 7 % 20);
    for (std::uint64_t at = piece; at < 400; at += piece)
      robot.run(at);
    robot.run(400);
    return robot.trace();
  };
  const std::string whole = trace(400);
  CHECK(whole.size() > 1000);
  CHECK(trace(1) == whole);
  CHECK(trace(17) == whole);
}

TEST_CASE("two robots in one process do not know of each other") {
  const auto feed = [](Robot& robot, int phase) {
    for (int i = 0; i < 30; ++i)
      robot.feed(static_cast<std::uint64_t>(i) * 10, "X", (i * phase) % 25);
  };
  Robot alone(kWatchX);
  feed(alone, 7);
  alone.run(2000);

  Robot one(kWatchX);
  Robot other(kWatchX);
  feed(one, 7);
  feed(other, 11);
  for (std::uint64_t at = 0; at <= 2000; at += 50) {
    one.run(at);
    other.run(at);
  }
  CHECK(one.trace() == alone.trace());
  CHECK(other.trace() != alone.trace());
}
