// The time words in rules, and the effect of COOLDOWN, WAITING and RESTARTING on triggers.
#include <catch2/catch.hpp>

#include "tests/runtime-m4/robot.hpp"

using robosync::test::Robot;

TEST_CASE("FOR: true all the time, one false sample begins anew, no reading is needed at the end") {
  Robot robot("WHEN near X > 10 FOR 300ms\nDO LOG \"held\"\nELSE\nLOG \"not\"\nEND\n");
  robot.feed(0, "X", 20);
  robot.feed(200, "X", 5);
  robot.feed(250, "X", 20);
  robot.feed(700, "X", 5);
  robot.run(2000);
  CHECK(robot.only("log") == "0 #1 log \"not\"\n550 #4 log \"held\"\n700 #5 log \"not\"\n");
}

TEST_CASE("a reading comes before the time that is over in the same millisecond") {
  Robot robot("WHEN near X > 10 FOR 300ms\nDO LOG \"held\"\nEND\n");
  robot.feed(0, "X", 20);
  robot.feed(300, "X", 5);
  robot.feed(400, "X", 20);
  robot.feed(701, "X", 5);
  robot.run(1000);
  CHECK(robot.only("log") == "700 #4 log \"held\"\n");
}

TEST_CASE("TIMES WITHIN: so many rising edges inside a window, then it counts anew") {
  Robot robot("WHEN near X > 10 3 TIMES WITHIN 1s\nDO LOG \"often\"\nEND\n");
  for (const int at : {0, 600, 1200, 1500, 1800, 2000, 2200})
    for (int up = 1; up >= 0; --up)
      robot.feed(static_cast<std::uint64_t>(at + (up == 1 ? 0 : 50)), "X", up * 20);
  robot.run(4000);
  std::string at;
  for (const std::string& line : robot.lines())
    if (line.find(" log ") != std::string::npos) at += line.substr(0, line.find(' ')) + " ";
  // 600, 1200, 1500 are within a second, then 1800, 2000, 2200.
  CHECK(at == "1500 2200 ");
}

TEST_CASE("THEN WITHIN: one after the other, in time") {
  Robot robot("WHEN near X > 10 THEN far Y > 10 WITHIN 500ms\nDO LOG \"both\"\nEND\n");
  robot.feed(0, "X", 0);
  robot.feed(0, "Y", 0);
  robot.feed(100, "X", 20);
  robot.feed(400, "Y", 20);  // in time
  robot.feed(1000, "Y", 0);
  robot.feed(1100, "Y", 20);  // the first one is used up
  robot.feed(1200, "X", 0);
  robot.feed(1300, "Y", 0);
  robot.feed(1400, "X", 20);
  robot.feed(2000, "Y", 20);  // too late
  robot.run(4000);
  CHECK(robot.only("log") == "400 #3 log \"both\"\n");
}

TEST_CASE("BECOMES and CHANGES need a value before; an event triggers each time") {
  Robot robot("WHEN near X CHANGES BY 5\nDO LOG \"moved\"\nEND\n");
  int at = 0;
  for (const int x : {20, 22, 25, 26, 31})
    robot.feed(static_cast<std::uint64_t>(at++), "X", x);
  robot.run(100);
  std::string seen;
  for (const std::string& line : robot.lines())
    if (line.find(" log ") != std::string::npos) seen += line.substr(0, line.find(' ')) + " ";
  CHECK(seen == "2 4 ");
}

TEST_CASE("COOLDOWN drops triggers after a response has started, not after one that lost") {
  Robot robot("WHEN near X > 10\nCOOLDOWN 1s\nDO LOG \"hi\"\nEND\n");
  for (int i = 0; i < 15; ++i)
    robot.feed(static_cast<std::uint64_t>(i) * 100, "X", i % 2 == 0 ? 20 : 5);
  robot.run(3000);
  CHECK(robot.only("fire log") ==
        "0 #1 fire r0 DO\n0 #1 log \"hi\"\n1000 #11 fire r0 DO\n1000 #11 log \"hi\"\n");
}

TEST_CASE("rules cool down by themselves") {
  Robot robot(
      "WHEN near X > 10\nCOOLDOWN 1s\nDO LOG \"near\"\nEND\n"
      "WHEN near X > 0\nDO LOG \"there\"\nEND\n"
      "WHEN far Y > 10\nCOOLDOWN 1s\nDO LOG \"far\"\nEND\n");
  robot.feed(0, "X", 20);
  robot.feed(200, "Y", 20);
  robot.feed(300, "Y", 0);
  robot.feed(1050, "X", 0);
  robot.feed(1100, "X", 20);  // far has been cooling down since 200, near since 0
  robot.feed(1150, "Y", 20);
  robot.run(3000);
  CHECK(robot.only("fire") ==
        "0 #1 fire r0 DO\n0 #1 fire r1 DO\n200 #2 fire r2 DO\n"
        "1100 #5 fire r0 DO\n1100 #5 fire r1 DO\n");
}

TEST_CASE("each side of a WHEN/ELSE cools down by itself, and the rule ends on its side") {
  Robot robot("WHEN near X > 10\nCOOLDOWN 1s\nDO MOVE a FOR 5s\nELSE\nMOVE a FOR 3s\nEND\n");
  robot.feed(0, "X", 20);
  robot.feed(200, "X", 5);
  robot.feed(300, "X", 20);   // DO cools down until 1000
  robot.feed(1100, "X", 5);   // ELSE until 1200 …
  robot.feed(1150, "X", 20);  // … and is not chosen any more then
  robot.run(5000);
  CHECK(robot.only("fire win interrupt") ==
        "0 #1 fire r0 DO\n0 #1 win r0 DO\n"
        "200 #2 fire r0 ELSE\n200 #2 interrupt r0 by b0\n200 #2 win r0 ELSE\n"
        "1000 #4 interrupt r0 by b0\n1000 #4 win r0 DO\n");
}

TEST_CASE("a side that is denied starts when its actuators are free, if it is still chosen") {
  Robot robot(robosync::test::high_and_low(
      robosync::test::when_far("MOVE a FOR 500ms"),
      robosync::test::rule("WHEN near X > 10", "MOVE a FOR 100ms\nELSE\nMOVE a FOR 50ms")));
  robot.feed(0, "X", 0);
  robot.feed(200, "Y", 60);
  robot.feed(300, "X", 20);
  robot.feed(1000, "Y", 0);
  robot.feed(1100, "Y", 60);
  robot.feed(1200, "X", 0);
  robot.feed(1300, "X", 20);  // DO ran last, but the other rule has had its actuator since
  robot.run(3000);
  CHECK(robot.only("win lose") ==
        "0 #1 win r1 ELSE\n200 #2 win r0 DO\n300 #3 lose r1 DO to b0\n700 #4 win r1 DO\n"
        "1100 #6 win r0 DO\n1200 #7 lose r1 ELSE to b0\n1300 #8 lose r1 DO to b0\n"
        "1600 #9 win r1 DO\n");
}

TEST_CASE("a side that was interrupted is not taken up again, unless it is chosen again") {
  Robot robot(robosync::test::high_and_low(
      robosync::test::when_far("MOVE a FOR 500ms"),
      robosync::test::rule("WHEN near X > 10", "MOVE a FOR 300ms\nELSE\nMOVE a FOR 50ms")));
  robot.feed(0, "X", 20);
  robot.feed(100, "Y", 60);
  robot.feed(1000, "Y", 0);
  robot.run(1500);
  CHECK(robot.only("win lose interrupt") ==
        "0 #1 win r1 DO\n100 #2 interrupt r1 by b0\n100 #2 win r0 DO\n");
}

TEST_CASE("a WHILE with COOLDOWN starts again when that is over") {
  Robot robot("WHILE near X > 10\nCOOLDOWN 500ms\nDO MOVE a FOR 100ms\nEND\n");
  robot.feed(0, "X", 20);
  robot.feed(1100, "X", 5);
  robot.run(3000);
  CHECK(robot.only("fire win finished interrupt") ==
        "0 #1 fire r0 DO\n0 #1 win r0 DO\n100 #1 finished r0\n500 #2 win r0 DO\n"
        "600 #2 finished r0\n1000 #3 win r0 DO\n1100 #3 finished r0\n");
}

TEST_CASE("RESTARTING interrupts itself and begins from the top") {
  Robot robot("WHEN near X > 10\nRESTARTING\nDO MOVE a FOR 1s\nEND\n");
  robot.feed(0, "X", 20);
  robot.feed(300, "X", 5);
  robot.feed(400, "X", 20);
  robot.run(3000);
  CHECK(robot.only("interrupt win lose cancel done") ==
        "0 #1 win r0 DO\n400 #3 interrupt r0 by b0\n400 #3 win r0 DO\n400 #3 cancel a\n"
        "1400 #3 done a\n");
}

TEST_CASE("WAITING takes the actuator when it gets free, but not later than it said") {
  const char* const program = R"(
BEHAVIOR high PRIORITY 20
  WHEN far Y > 50
  DO MOVE a FOR 500ms
  END
END
BEHAVIOR low PRIORITY 10
  WHEN near X > 10
  WAITING 300ms
  DO MOVE a FOR 100ms
  END
END
)";
  Robot robot(program);
  robot.feed(0, "Y", 60);
  robot.feed(100, "X", 20);  // waits until 400
  robot.run(450);
  robot.feed(450, "X", 5);
  robot.feed(460, "X", 20);  // waits until 760
  robot.run(1000);
  CHECK(robot.only("fire win lose") ==
        "0 #1 fire r0 DO\n0 #1 win r0 DO\n100 #2 fire r1 DO\n100 #2 lose r1 DO to b0\n"
        "460 #4 fire r1 DO\n460 #4 lose r1 DO to b0\n500 #5 win r1 DO\n");
}

TEST_CASE("SMOOTH: the median moves on after the last reading, in the raster of the samples") {
  Robot robot(R"(
CHECK space OF near X
  close BELOW 30
  far   OTHERWISE
  SMOOTH OVER 100ms
END
WHEN space IS close
DO LOG "close"
END
)",
              R"({"sensors": [{"name": "near", "type": "VIRTUAL",
    "channels": {"X": {"range": [0, 100], "rate": "50Hz"}}}],
    "actuators": [{"name": "a", "type": "VIRTUAL", "device": "virtual_actuator"}]})");
  robot.feed(0, "X", 50);
  robot.feed(100, "X", 10);  // one sample of five
  robot.feed(120, "X", 50);
  robot.feed(200, "X", 10);  // stays: samples at 200, 220, 240, which is over a millisecond later
  robot.run(1000);
  CHECK(robot.only("set").substr(0, 16) == "0 #1 set space 1");
  std::string seen;
  for (const std::string& line : robot.lines())
    if (line.find(" log ") != std::string::npos) seen += line.substr(0, line.find(' ')) + " ";
  CHECK(seen == "241 ");
}

TEST_CASE("a division by zero is told, of conditions and of responses") {
  Robot robot(
      "WHEN 10 / near X > 1\nDO MOVE a FOR (1s / near X)\nELSE\nLOG \"v \", 1 / near X\nEND\n");
  robot.feed(0, "X", 0);
  robot.run(100);
  CHECK(robot.only("zero_divide fire log") ==
        "0 #1 zero_divide r0\n0 #1 fire r0 ELSE\n0 #1 zero_divide r0\n0 #1 log \"v {}\" 0\n");
}

TEST_CASE("a division by zero is told of a condition from which nothing else follows") {
  Robot robot("WHEN 10 / near X > 1\nDO LOG \"v\"\nEND\n");
  robot.feed(0, "X", 0);
  robot.feed(40, "X", 50);
  robot.feed(80, "X", 0);
  robot.run(200);
  CHECK(robot.only("zero_divide fire log") == "0 #1 zero_divide r0\n80 #3 zero_divide r0\n");
}
