// From triggers to commands: which responses run, which are interrupted, and the order of the actuators' commands.
#include <sstream>
#include <string>

#include <catch2/catch.hpp>

#include "tests/runtime-m4/robot.hpp"
#include "tests/support/repeated.hpp"

using robosync::test::high_and_low;
using robosync::test::Robot;
using robosync::test::rule;
using robosync::test::when_far;
using robosync::test::when_near;
using robosync::testing::repeated;

TEST_CASE("a WHEN that triggers while it runs is ignored") {
  Robot robot(when_near("MOVE a FOR 1s"));
  robot.feed(0, "X", 20);
  robot.feed(100, "X", 5);
  robot.feed(200, "X", 20);
  robot.feed(1100, "X", 5);
  robot.feed(1200, "X", 20);
  robot.run(1500);
  CHECK(robot.only("fire win lose command done") ==
        "0 #1 fire r0 DO\n0 #1 win r0 DO\n0 #1 command a MOVE for_=1\n"
        "200 #3 fire r0 DO\n200 #3 lose r0 DO to b0\n1000 #3 done a\n"
        "1200 #5 fire r0 DO\n1200 #5 win r0 DO\n1200 #5 command a MOVE for_=1\n");
}

TEST_CASE("the chosen side of a WHEN/ELSE replaces the running one, whatever each uses") {
  Robot robot("WHEN near X > 10\nDO\nMOVE a\nMOVE b\nELSE\nMOVE c\nEND\n");
  robot.feed(0, "X", 20);
  robot.feed(100, "X", 5);
  robot.run(2000);
  CHECK(robot.only("interrupt win cancel command finished") ==
        "0 #1 win r0 DO\n0 #1 command a MOVE\n0 #1 command b MOVE\n"
        "100 #2 interrupt r0 by b0\n100 #2 win r0 ELSE\n100 #2 cancel a\n100 #2 cancel b\n"
        "100 #2 command c MOVE\n1100 #2 finished r0\n");
}

TEST_CASE("choosing the other side ends the running one even if the new side cannot start") {
  Robot robot(high_and_low(when_far("MOVE b FOR 10s"),
                           rule("WHEN near X > 10", "MOVE a FOR 10s\nELSE\nMOVE a\nMOVE b")));
  robot.feed(0, "Y", 60);
  robot.feed(0, "X", 20);
  robot.feed(100, "X", 5);
  robot.run(500);
  CHECK(robot.only("interrupt lose cancel") ==
        "100 #2 interrupt r1 by b1\n100 #2 lose r1 ELSE to b0\n100 #2 cancel a\n");
}

TEST_CASE("in one step, of two rules of a behaviour the earlier in the file wins") {
  Robot robot(R"(
BEHAVIOR single PRIORITY 10
  WHEN near X > 10
  DO MOVE a FOR 100ms
  END
  WHEN near X > 20
  DO MOVE a FOR 200ms
  END
END
)");
  robot.feed(0, "X", 30);
  robot.feed(500, "X", 0);
  robot.feed(600, "X", 15);
  robot.feed(650, "X", 25);  // now it is the later trigger
  robot.run(2000);
  CHECK(robot.only("win lose interrupt") ==
        "0 #1 win r0 DO\n0 #1 lose r1 DO to b0\n"
        "600 #3 win r0 DO\n650 #4 interrupt r0 by b0\n650 #4 win r1 DO\n");
}

TEST_CASE("a response that loses one actuator loses all; others run on") {
  Robot robot(high_and_low(when_far("MOVE b"), when_near("MOVE a FOR 5s\nMOVE b FOR 5s") +
                                                   rule("WHEN near X > 15", "MOVE d FOR 5s")));
  robot.feed(0, "X", 20);
  robot.feed(100, "Y", 60);
  robot.run(6000);
  CHECK(robot.only("interrupt cancel done finished") ==
        "100 #2 interrupt r1 by b0\n100 #2 cancel b\n100 #2 cancel a\n"
        "1100 #2 done b\n1100 #2 finished r0\n5000 #2 done d\n5000 #2 finished r2\n");
}

TEST_CASE("an interrupted response is not resumed") {
  Robot robot(
      high_and_low(when_far("MOVE a FOR 100ms"), when_near("MOVE a FOR 1s\nMOVE a SLOWLY")));
  robot.feed(0, "X", 20);
  robot.feed(100, "Y", 60);
  robot.run(5000);
  CHECK(robot.only("command") == "0 #1 command a MOVE for_=1\n100 #2 command a MOVE for_=0.100\n");
}

TEST_CASE("a rule outside a BEHAVIOR stands below every numbered one, earlier above later") {
  Robot robot(R"(
WHEN near X > 10
DO MOVE a FOR 1s
END
WHEN near X > 20
DO MOVE a FOR 2s
END
BEHAVIOR least PRIORITY 1
  WHEN near X > 30
  DO MOVE a FOR 3s
  END
END
)");
  robot.feed(0, "X", 25);
  robot.feed(100, "X", 35);
  robot.run(200);
  CHECK(robot.only("command") == "0 #1 command a MOVE for_=1\n100 #2 command a MOVE for_=3\n");
}

TEST_CASE("two commands to one actuator run one after the other") {
  Robot robot(
      "WHEN near X > 10\nDO\nMOVE a FOR 10ms\nMOVE bc FOR 5ms\nMOVE a FOR 20ms\n"
      "MOVE b FOR 50ms\nEND\n");
  robot.feed(0, "X", 20);
  robot.run(200);
  CHECK(robot.only("command done finished") ==
        "0 #1 command a MOVE for_=0.010\n0 #1 command b MOVE for_=0.005\n"
        "0 #1 command c MOVE for_=0.005\n"
        "5 #1 done b\n5 #1 command b MOVE for_=0.050\n5 #1 done c\n"
        "10 #1 done a\n10 #1 command a MOVE for_=0.020\n30 #1 done a\n"
        "55 #1 done b\n55 #1 finished r0\n");
}

TEST_CASE("eight commands wait for an actuator, more are dropped, which is said once a response") {
  const auto moves = [](int count) {
    std::string text;
    for (int i = 0; i < count; ++i)
      text += "MOVE a FOR 10ms\n";
    return text;
  };
  // The first one is under way, so there is room for one of three.
  Robot robot("WHEN near X > 10\nDO\n" + moves(8) + "WAIT 5ms\n" + moves(3) +
              "MOVE b FOR 7ms\nEND\n");
  robot.feed(0, "X", 20);
  robot.run(200);
  CHECK(robot.only("overrun") == "5 #2 overrun a\n");
  CHECK_THAT(robot.only("done"),
             Catch::StartsWith("10 #2 done a\n") && Catch::Contains("12 #2 done b\n"));
  CHECK(robot.only("finished") == "90 #2 finished r0\n");
}

TEST_CASE("commands that are done at once, and the queue behind them") {
  Robot robot(when_near("STOP a\nMOVE a FOR 0ms\nMOVE a FOR 5ms"));
  robot.feed(0, "X", 20);
  robot.run(200);
  CHECK(robot.only("command done finished") ==
        "0 #1 command a STOP\n0 #1 done a\n0 #1 command a MOVE for_=0\n0 #1 done a\n"
        "0 #1 command a MOVE for_=0.005\n5 #1 done a\n5 #1 finished r0\n");
}

TEST_CASE("a command with an unknown parameter is seen and not carried out") {
  Robot robot(when_near("RUN a TO (far Y)\nMOVE a FOR 5ms"));
  robot.feed(0, "X", 20);
  robot.run(200);
  CHECK(robot.only("command done") ==
        "0 #1 command a RUN to=unknown\n0 #1 done a\n"
        "0 #1 command a MOVE for_=0.005\n5 #1 done a\n");
}

TEST_CASE("a cancelled queue gives its places back and never runs") {
  Robot robot("WHEN near X > 10\nDO\n" + repeated("MOVE a FOR 50ms\n", 8) +
              "ELSE\nMOVE b FOR 5ms\nEND\n");
  for (int i = 0; i < 12; ++i)
    robot.feed(static_cast<std::uint64_t>(i) * 20, "X", i % 2 == 0 ? 20 : 5);
  robot.run(2000);
  CHECK(robot.only("overrun").empty());
  // Six times the first of the eight, and none of the others.
  std::string expected;
  for (int i = 0; i < 12; i += 2)
    expected += std::to_string(i * 20) + " #" + std::to_string(i + 1) +
                " command a MOVE for_=0.050\n" + std::to_string(i * 20 + 20) + " #" +
                std::to_string(i + 2) + " command b MOVE for_=0.005\n";
  CHECK(robot.only("command") == expected);
}

// Whatever the ranks of their threads, which depend on other behaviours.
TEST_CASE("what an actuator has done at a time is over before anything else of that time") {
  for (const char* const other :
       {"", "BEHAVIOR top PRIORITY 90\n  WHEN far Y > 50\n  DO MOVE d\n  END\nEND\n"}) {
    INFO("beside: " << other);
    Robot robot(std::string(other) + R"(
BEHAVIOR middle PRIORITY 50
  WHEN near X > 20
  DO MOVE a FOR 1s
  END
END
BEHAVIOR low PRIORITY 10
  WHEN near X > 10
  DO MOVE a FOR 100ms
  END
END
BEHAVIOR lowest PRIORITY 5
  EVERY 200ms
  DO MOVE b FOR 200ms
  END
END
)");
    robot.feed(0, "X", 15);
    robot.feed(100, "X", 25);
    robot.run(650);
    std::string seen;
    for (const char* const what : {"interrupt cancel", "command", "done"}) {
      for (const std::string& line : robot.lines()) {
        std::istringstream words(line);
        std::string time, step, kind, actuator;
        words >> time >> step >> kind >> actuator;
        if (std::string(what).find(kind) != std::string::npos)
          seen += time + ' ' + kind + ' ' + actuator + ", ";
      }
    }
    CHECK(seen ==
          "0 command a, 100 command a, 200 command b, 400 command b, 600 command b, "
          "100 done a, 400 done b, 600 done b, ");
  }
}

TEST_CASE("what an interrupted response had in its queue takes no place from its successor") {
  const std::string sweep = repeated("MOVE a FOR 50ms\n", 8);
  Robot robot(high_and_low(when_far(sweep), when_near(sweep)));
  robot.feed(0, "X", 20);
  robot.feed(10, "Y", 60);
  robot.run(1000);
  CHECK(robot.only("overrun").empty());
  CHECK(robot.only("finished") == "410 #2 finished r0\n");
}
