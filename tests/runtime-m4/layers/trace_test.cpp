// Whole programs on the whole runtime: the robot's trace, event by event.
#include <catch2/catch.hpp>

#include "tests/runtime-m4/robot.hpp"
#include "tests/support/golden.hpp"

using robosync::test::Robot;
using robosync::testing::expect_golden;
using robosync::testing::read_file;

namespace {

const std::string kGolden = ROBOSYNC_SOURCE_DIR "/tests/runtime-m4/layers/golden/";
const std::string kExamples = ROBOSYNC_SOURCE_DIR "/examples/";

}  // namespace

TEST_CASE("the paper's program answers touch levels 0 to 5") {
  Robot robot(read_file(kExamples + "touch_companion/robot.rsl"),
              read_file(kExamples + "touch_companion/robot.json"));
  for (int level = 0; level <= 5; ++level)
    robot.feed(static_cast<std::uint64_t>(level) * 1000, "LEVEL", level);
  robot.run(12'000);
  expect_golden(kGolden + "paper.txt", robot.trace());
}

TEST_CASE("priorities, interruption and queues") {
  Robot robot(R"(
BEHAVIOR calm PRIORITY 10
  WHEN near X > 10
  DO
    MOVE a FOR 2s
    MOVE a SLOWLY FOR 1s
    PLAY d FOR 5s
  END
  WHEN near X > 20
  DO MOVE bc TO 20% OVER 500ms
  END
END
BEHAVIOR alarm PRIORITY 90
  WHEN far Y > 50
  DO
    MOVE bc TO (far Y * 10) QUICKLY
    PLAY d
  ELSE
    MOVE c
  END
END
)");
  robot.feed(0, "X", 15);
  robot.feed(100, "X", 25);
  robot.feed(200, "Y", 10);
  robot.feed(1000, "Y", 60);
  robot.feed(1500, "X", 5);
  robot.feed(1600, "X", 15);
  robot.feed(8000, "X", 5);
  robot.feed(8001, "X", 15);
  robot.run(15'000);
  expect_golden(kGolden + "priorities.txt", robot.trace());
}
