// WHILE: runs as long as its condition is true and its actuators are available.
#include <catch2/catch.hpp>

#include "tests/runtime-m4/robot.hpp"

using robosync::test::high_and_low;
using robosync::test::Robot;
using robosync::test::rule;
using robosync::test::when_far;
using robosync::test::when_near;

TEST_CASE("WHILE starts again when it finishes and still holds, and ends with its condition") {
  Robot robot("WHILE near X > 10\nDO MOVE a FOR 100ms\nEND\n");
  robot.feed(0, "X", 20);
  robot.feed(250, "X", 5);
  robot.run(1000);
  CHECK(robot.only("fire win finished interrupt cancel command") ==
        "0 #1 fire r0 DO\n0 #1 win r0 DO\n0 #1 command a MOVE for_=0.100\n"
        "100 #1 finished r0\n100 #2 win r0 DO\n100 #2 command a MOVE for_=0.100\n"
        "200 #2 finished r0\n200 #3 win r0 DO\n200 #3 command a MOVE for_=0.100\n"
        "250 #4 interrupt r0 by b0\n250 #4 cancel a\n");
}

TEST_CASE("a WHILE that takes no time starts every 20 ms") {
  Robot robot("WHILE near X > 10\nDO MOVE a FOR 0ms\nEND\n");
  robot.feed(10, "X", 20);
  robot.feed(55, "X", 5);
  robot.run(100);
  CHECK(robot.only("win interrupt cancel") ==
        "10 #1 win r0 DO\n30 #2 win r0 DO\n50 #3 win r0 DO\n");
}

TEST_CASE("a round that takes 5 ms is finished then, and the next one begins 15 ms later") {
  Robot robot("WHILE near X > 10\nDO MOVE a FOR 5ms\nEND\n");
  robot.feed(0, "X", 20);
  robot.run(30);
  CHECK(robot.only("win finished") ==
        "0 #1 win r0 DO\n5 #1 finished r0\n20 #2 win r0 DO\n25 #2 finished r0\n");
}

TEST_CASE("rounds that wait are as short as their waits") {
  Robot robot("WHILE near X > 10\nDO\nMOVE a FOR 1ms\nWAIT 5ms\nEND\n");
  robot.feed(0, "X", 20);
  robot.feed(12, "X", 0);
  robot.run(30);
  CHECK(robot.only("win interrupt") ==
        "0 #1 win r0 DO\n5 #3 win r0 DO\n10 #5 win r0 DO\n12 #6 interrupt r0 by b0\n");
}

TEST_CASE(
    "a condition that becomes true again starts a WHILE at once, after a short round as well") {
  Robot robot("WHILE near X > 10\nDO MOVE a FOR 0ms\nEND\n");
  robot.feed(0, "X", 20);
  robot.feed(3, "X", 0);
  robot.feed(6, "X", 20);
  robot.run(30);
  CHECK(robot.only("fire win") ==
        "0 #1 fire r0 DO\n0 #1 win r0 DO\n6 #3 fire r0 DO\n6 #3 win r0 DO\n26 #4 win r0 DO\n");
}

TEST_CASE("a WHILE comes back 20 ms after it was interrupted, not sooner") {
  Robot robot(high_and_low(when_far("MOVE a FOR 2ms"), rule("WHILE near X > 10", "MOVE a FOR 1s")));
  robot.feed(0, "X", 20);
  robot.feed(100, "Y", 60);
  robot.run(200);
  CHECK(robot.only("win finished") ==
        "0 #1 win r1 DO\n100 #2 win r0 DO\n102 #2 finished r0\n120 #3 win r1 DO\n");
}

TEST_CASE("an unknown condition ends a WHILE, and known again it fires again") {
  Robot robot("WHILE near X > 10\nDO MOVE a FOR 10s\nEND\n", R"({
    "sensors": [{"name": "near", "type": "VIRTUAL",
                 "channels": {"X": {"range": [0, 100], "stale_after": "200ms"}}}],
    "actuators": [{"name": "a", "type": "VIRTUAL", "device": "virtual_actuator"}]})");
  robot.feed(0, "X", 20);
  robot.feed(500, "X", 20);
  robot.run(600);
  CHECK(robot.only("stale fire win interrupt") ==
        "0 #1 fire r0 DO\n0 #1 win r0 DO\n201 #2 stale X\n201 #2 interrupt r0 by b0\n"
        "500 #3 fire r0 DO\n500 #3 win r0 DO\n");
}

TEST_CASE("a WHILE that loses says so once, and starts when its actuator is free") {
  Robot robot(
      high_and_low(when_far("MOVE a FOR 300ms"), rule("WHILE near X > 10", "MOVE a FOR 1s")));
  robot.feed(0, "Y", 60);
  robot.feed(100, "X", 20);
  robot.feed(150, "X", 25);
  robot.feed(200, "Y", 70);
  robot.run(1000);
  CHECK(robot.only("fire win lose finished") ==
        "0 #1 fire r0 DO\n0 #1 win r0 DO\n100 #2 fire r1 DO\n100 #2 lose r1 DO to b0\n"
        "300 #4 finished r0\n300 #5 win r1 DO\n");
}

TEST_CASE("a WHILE that was interrupted comes back when it can") {
  Robot robot(
      high_and_low(when_far("MOVE a FOR 300ms"), rule("WHILE near X > 10", "MOVE a FOR 1s")));
  robot.feed(0, "X", 20);
  robot.feed(100, "Y", 60);
  robot.run(1000);
  CHECK(robot.only("fire win lose interrupt") ==
        "0 #1 fire r1 DO\n0 #1 win r1 DO\n100 #2 fire r0 DO\n100 #2 interrupt r1 by b0\n"
        "100 #2 win r0 DO\n400 #3 win r1 DO\n");
}

TEST_CASE("two WHILEs of one behaviour do not take turns by force") {
  Robot robot(R"(
BEHAVIOR both PRIORITY 20
  WHILE near X > 10
  DO MOVE a FOR 100ms
  END
  WHILE near X > 20
  DO MOVE a FOR 50ms
  END
END
)");
  robot.feed(0, "X", 30);
  robot.feed(250, "X", 0);
  robot.run(1000);
  CHECK(robot.only("win lose interrupt") ==
        "0 #1 win r0 DO\n0 #1 lose r1 DO to b0\n100 #2 win r0 DO\n200 #3 win r0 DO\n"
        "250 #4 interrupt r0 by b0\n");
}

TEST_CASE("a claim takes what a WHILE has given up in the same step") {
  Robot robot(
      high_and_low(rule("WHILE near X < 10", "MOVE a FOR 1s"), when_near("MOVE a FOR 50ms")));
  robot.feed(0, "X", 5);
  robot.feed(100, "X", 20);
  robot.run(300);
  CHECK(robot.only("fire interrupt win lose cancel command") ==
        "0 #1 fire r0 DO\n0 #1 win r0 DO\n0 #1 command a MOVE for_=1\n"
        "100 #2 interrupt r0 by b0\n100 #2 cancel a\n100 #2 fire r1 DO\n100 #2 win r1 DO\n"
        "100 #2 command a MOVE for_=0.050\n");
}

TEST_CASE("a WHILE keeps its actuators between rounds, and rounds do not drift") {
  Robot robot(high_and_low(rule("WHILE near X > 10", "MOVE a FOR 10ms\nWAIT 50ms"),
                           rule("WHILE far Y > 10", "MOVE a FOR 1s")));
  robot.feed(0, "X", 20);
  robot.feed(0, "Y", 20);
  robot.feed(120, "X", 0);
  robot.run(130);
  CHECK(robot.only("win lose interrupt") ==
        "0 #1 win r0 DO\n0 #1 lose r1 DO to b0\n50 #3 win r0 DO\n100 #5 win r0 DO\n"
        "120 #6 interrupt r0 by b0\n120 #6 win r1 DO\n");
}

TEST_CASE("a WHILE keeps its actuators while it cools down, and lets go of them without a word") {
  Robot robot(high_and_low(rule("WHILE near X > 10 COOLDOWN 300ms", "MOVE a FOR 50ms"),
                           rule("EVERY 100ms", "MOVE a FOR 10ms")));
  robot.feed(0, "X", 20);
  robot.feed(450, "X", 0);
  robot.run(550);
  CHECK(robot.only("win interrupt cancel") ==
        "0 #1 win r0 DO\n300 #4 win r0 DO\n500 #7 win r1 DO\n");
}

TEST_CASE("what ranks higher takes a WHILE that rests, and it comes back") {
  Robot robot(high_and_low(when_far("MOVE a FOR 30ms"),
                           rule("WHILE near X > 10 COOLDOWN 100ms", "MOVE a FOR 10ms")));
  robot.feed(0, "X", 20);
  robot.feed(90, "Y", 60);
  robot.run(150);
  CHECK(robot.only("win interrupt cancel lose") ==
        "0 #1 win r1 DO\n90 #2 win r0 DO\n120 #3 win r1 DO\n");
}
