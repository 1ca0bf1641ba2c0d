// Adaptive priorities in whole programs: a behaviour that is triggered often overtakes a calm one
// and falls back; only the order of threads changes.
#include <catch2/catch.hpp>

#include "tests/runtime-m4/rig.hpp"
#include "tests/runtime-m4/robot.hpp"

using namespace robosync;
using test::Rig;
using test::Robot;

namespace {

std::string adapting(const std::string& scheduler = R"({"alpha": 2, "window": "1s"})") {
  std::string json = test::kPlainRobot;
  return json.insert(json.find('{') + 1, "\"scheduler\": " + scheduler + ",");
}

// Each acts on its own actuator; the third reads what the other two read.
const char* const kThree = R"(
BEHAVIOR calm PRIORITY 20
  WHEN near X > 50
  DO MOVE a
  END
END
BEHAVIOR busy PRIORITY 10
  WHEN far Y > 50
  DO MOVE b
  END
END
BEHAVIOR both PRIORITY 5
  WHEN near X > 90 AND far Y > 90
  DO PLAY d
  END
END
)";

std::string order(const Rig& rig) {
  std::string order;
  for (const kernel::Thread* thread : rig.kernel.threads())
    order += std::string(thread->name()) + ":" + std::to_string(thread->priority().now) + " ";
  return order;
}

// `count` triggers of the rule for channel Y > 50, spread evenly over a second from `from_ms` on.

void trigger(Robot& robot, std::uint64_t from_ms, unsigned count) {
  for (unsigned i = 0; i < count; ++i) {
    robot.feed(from_ms + i * 1000 / count + 1, "Y", 60);
    robot.feed(from_ms + i * 1000 / count + 2, "Y", 0);
  }
}

void trigger(Rig& rig, std::uint64_t from_ms, unsigned count) {
  for (unsigned i = 0; i < count; ++i) {
    REQUIRE(rig.feed(1, 60, from_ms + i * 1000 / count + 1) == link::FeedError::none);
    REQUIRE(rig.feed(1, 0, from_ms + i * 1000 / count + 2) == link::FeedError::none);
  }
}

const char* const kAsWritten = "safety:0 a:20 b:10 d:5 calm:20 step:20 feeds:20 busy:10 both:5 ";

}  // namespace

TEST_CASE("a busy behaviour overtakes a calm one for a window, with all its threads") {
  Rig rig;
  REQUIRE(rig.activate(test::compile(kThree, adapting())).ok());
  CHECK(order(rig) == kAsWritten);
  trigger(rig, 0, 8);
  rig.run(999);
  CHECK(order(rig) == kAsWritten);  // the window has not ended
  rig.run(1000);
  // 8 triggers in a second at α = 2 are worth 16. The sensor thread and the step thread are shared.
  CHECK(order(rig) == "safety:0 b:26 a:20 d:5 busy:26 step:26 feeds:26 calm:20 both:5 ");
  rig.run(2000);
  CHECK(order(rig) == kAsWritten);
  CHECK(rig.only("priority") == "1000 #16 priority b1 26\n2000 #16 priority b1 10\n");
}

TEST_CASE("each window counts anew: the same load gives the same priority, not more") {
  Robot robot(kThree, adapting());
  for (unsigned second = 0; second < 4;
       ++second)  // the last window ends at 4000, the calm one at 5000
    trigger(robot, second * 1000, 3);
  robot.run(10'000);
  CHECK(robot.only("priority") == "1000 #6 priority b1 16\n5000 #24 priority b1 10\n");
}

TEST_CASE("nobody is raised beyond the cap, and the cap lowers nobody") {
  Rig rig;
  REQUIRE(rig.activate(test::compile(kThree, adapting(R"({"window": "1s", "cap": 15})"))).ok());
  trigger(rig, 0, 15);
  rig.run(1000);
  CHECK(order(rig) == "safety:0 a:20 b:15 d:5 calm:20 step:20 feeds:20 busy:15 both:5 ");
}

TEST_CASE("with equal priorities the one written higher stays above, in all its threads") {
  Rig rig;
  REQUIRE(rig.activate(test::compile(kThree, adapting())).ok());
  trigger(rig, 0, 5);
  rig.run(1000);
  CHECK(order(rig) == "safety:0 a:20 b:20 d:5 calm:20 step:20 feeds:20 busy:20 both:5 ");
}

TEST_CASE("without a scheduler in robot.json, or with alpha 0, nothing adapts") {
  for (const std::string& json :
       {std::string(test::kPlainRobot), adapting(R"({"alpha": 0, "window": "1s"})")}) {
    Rig rig;
    REQUIRE(rig.activate(test::compile(kThree, json)).ok());
    trigger(rig, 0, 20);
    rig.run(1000);
    CHECK(order(rig) == kAsWritten);
    CHECK(rig.only("priority").empty());
  }
}

TEST_CASE("who owns an actuator is decided by the priorities as they are written") {
  const char* const kRivals = R"(
BEHAVIOR calm PRIORITY 20
  WHEN near X > 50
  DO MOVE a FOR 5s
  END
END
BEHAVIOR busy PRIORITY 10
  WHEN far Y > 50
  DO MOVE a FOR 10ms
  END
END
)";
  Robot robot(kRivals, adapting());
  trigger(robot, 0, 10);
  robot.feed(1500, "X", 60);  // calm takes the free actuator …
  trigger(robot, 1600, 1);    // … and busy, with a priority of 30 now, does not get it
  robot.run(1900);
  CHECK(robot.only("priority") == "1000 #20 priority b1 30\n");
  CHECK(robot.only("lose") == "1601 #22 lose r1 DO to b0\n");
}

TEST_CASE("a new program begins as it is written") {
  Rig rig;
  REQUIRE(rig.activate(test::compile(kThree, adapting())).ok());
  trigger(rig, 0, 8);
  rig.run(1500);
  CHECK(order(rig) != kAsWritten);
  REQUIRE(rig.activate(test::compile(kThree, adapting())).ok());
  CHECK(order(rig) == kAsWritten);
  rig.run(5000);
  CHECK(order(rig) == kAsWritten);
}

TEST_CASE("windows do not wake a program in which nothing happens") {
  Rig rig;
  REQUIRE(rig.activate(test::compile(kThree, adapting())).ok());
  rig.run(100);
  const auto before = rig.thread("step").activations();
  rig.run(60'000);
  CHECK(rig.thread("step").activations() == before);
}
