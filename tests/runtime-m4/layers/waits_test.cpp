// Responses that wait: for time, for their commands, for a condition.
#include <catch2/catch.hpp>

#include "tests/runtime-m4/robot.hpp"
#include "tests/support/repeated.hpp"

using robosync::test::high_and_low;
using robosync::test::Robot;
using robosync::test::when_far;
using robosync::test::when_near;
using robosync::testing::repeated;

TEST_CASE("WAIT goes on when its time is over, in a step of its own") {
  Robot robot(when_near("LOG \"one\"\nWAIT 200ms\nLOG \"two\""));
  robot.feed(50, "X", 20);
  robot.run(1000);
  CHECK(robot.only("win log wait go_on finished") ==
        "50 #1 win r0 DO\n50 #1 log \"one\"\n50 #1 wait r0\n"
        "250 #2 go_on r0\n250 #2 log \"two\"\n250 #2 finished r0\n");
}

TEST_CASE("WAIT gives up for a millisecond at least, also when it says none") {
  Robot robot(when_near("WAIT near X * 0ms\nWAIT near X * -5s\nLOG \"end\""));
  robot.feed(50, "X", 20);
  robot.run(1000);
  CHECK(robot.only("wait go_on log") ==
        "50 #1 wait r0\n51 #2 go_on r0\n51 #2 wait r0\n52 #3 go_on r0\n52 #3 log \"end\"\n");
}

TEST_CASE("THEN waits for all commands so far") {
  Robot robot(when_near("MOVE a FOR 30ms\nMOVE b FOR 80ms\nTHEN\nMOVE a FOR 10ms"));
  robot.feed(0, "X", 20);
  robot.run(1000);
  CHECK(robot.only("command done wait go_on finished") ==
        "0 #1 wait r0\n0 #1 command a MOVE for_=0.030\n0 #1 command b MOVE for_=0.080\n"
        "30 #1 done a\n80 #1 done b\n80 #2 go_on r0\n80 #2 command a MOVE for_=0.010\n"
        "90 #2 done a\n90 #2 finished r0\n");
}

TEST_CASE("THEN with nothing to wait for goes on after 20 ms") {
  Robot robot(when_near("THEN\nMOVE a FOR 0ms\nTHEN\nLOG \"end\""));
  robot.feed(10, "X", 20);
  robot.run(1000);
  CHECK(robot.only("wait go_on log finished") ==
        "10 #1 wait r0\n30 #2 go_on r0\n30 #2 wait r0\n50 #3 go_on r0\n50 #3 log \"end\"\n"
        "50 #3 finished r0\n");
}

TEST_CASE("THEN after commands that are done sooner goes on after 20 ms, not later") {
  Robot robot(when_near("MOVE a FOR 5ms\nTHEN\nMOVE a FOR 21ms\nTHEN\nLOG \"end\""));
  robot.feed(0, "X", 20);
  robot.run(1000);
  CHECK(robot.only("done go_on") == "5 #1 done a\n20 #2 go_on r0\n41 #2 done a\n41 #3 go_on r0\n");
}

TEST_CASE("a response keeps its actuators while it waits") {
  Robot robot(high_and_low(when_near("WAIT 500ms\nMOVE a FOR 10ms"), when_far("MOVE a FOR 10ms")));
  robot.feed(0, "X", 20);
  robot.feed(100, "Y", 60);
  robot.run(1000);
  CHECK(robot.only("win lose command") ==
        "0 #1 win r0 DO\n100 #2 lose r1 DO to b0\n500 #3 command a MOVE for_=0.010\n");
}

TEST_CASE("an interrupted response does not come back from its wait") {
  Robot robot(high_and_low(when_far("MOVE a FOR 10ms"),
                           when_near("MOVE a FOR 20ms\nWAIT 500ms\nMOVE a FOR 30ms")));
  robot.feed(0, "X", 20);
  robot.feed(100, "Y", 60);
  robot.run(2000);
  CHECK(robot.only("interrupt cancel command go_on") ==
        "0 #1 command a MOVE for_=0.020\n100 #2 interrupt r1 by b0\n100 #2 cancel a\n"
        "100 #2 command a MOVE for_=0.010\n");
}

TEST_CASE("WAIT UNTIL goes on in the step in which its condition is true") {
  Robot robot(when_near("WAIT UNTIL far Y > 50\nLOG \"end\""));
  robot.feed(0, "X", 20);
  robot.feed(100, "Y", 40);
  robot.feed(200, "Y", 60);
  robot.run(1000);
  CHECK(robot.only("input wait go_on log finished") ==
        "0 #1 input X 20\n0 #1 wait r0\n100 #3 input Y 40\n"
        "200 #4 input Y 60\n200 #4 go_on r0\n200 #4 log \"end\"\n200 #4 finished r0\n");
}

TEST_CASE("WAIT UNTIL that is true already goes on after 20 ms") {
  Robot robot(when_near("WAIT UNTIL near X > 5\nLOG \"end\""));
  robot.feed(7, "X", 20);
  robot.run(1000);
  CHECK(robot.only("wait go_on log") == "7 #1 wait r0\n27 #3 go_on r0\n27 #3 log \"end\"\n");
}

TEST_CASE("WAIT UNTIL misses nothing that is true for a moment in its first 20 ms") {
  Robot robot(when_near("WAIT UNTIL far Y CHANGES BY 40%\nLOG \"end\""));
  robot.feed(0, "X", 20);
  robot.feed(1, "Y", 10);
  robot.feed(3, "Y", 60);
  robot.feed(5, "Y", 10);
  robot.run(1000);
  CHECK(robot.only("wait go_on log") == "0 #1 wait r0\n20 #7 go_on r0\n20 #7 log \"end\"\n");
}

TEST_CASE("WAIT UNTIL goes on at once when its condition becomes true after 20 ms") {
  Robot robot(when_near("WAIT UNTIL far Y > 50\nWAIT UNTIL far Y < 50\nLOG \"end\""));
  robot.feed(0, "X", 20);
  robot.feed(20, "Y", 60);
  robot.feed(40, "Y", 40);
  robot.run(1000);
  CHECK(robot.only("go_on log") == "20 #3 go_on r0\n40 #5 go_on r0\n40 #5 log \"end\"\n");
}

TEST_CASE("WITHIN ends a wait for what does not come") {
  Robot robot(when_near("WAIT UNTIL far Y > 50 WITHIN 300ms\nLOG \"end\""));
  robot.feed(0, "X", 20);
  robot.feed(100, "Y", 40);
  robot.run(1000);
  CHECK(robot.only("wait go_on log") == "0 #1 wait r0\n300 #4 go_on r0\n300 #4 log \"end\"\n");
}

TEST_CASE("WAIT UNTIL with a time word: held long enough while it waits") {
  Robot robot(when_near("WAIT UNTIL far Y > 50 FOR 100ms\nLOG \"end\""));
  robot.feed(0, "X", 20);
  robot.feed(50, "Y", 60);
  robot.feed(120, "Y", 10);
  robot.feed(200, "Y", 60);
  robot.run(1000);
  CHECK(robot.only("go_on log") == "300 #6 go_on r0\n300 #6 log \"end\"\n");
}

TEST_CASE("a loop of waits goes on until its response is interrupted") {
  Robot robot(R"(
WHEN near X > 10
DO
  REPEAT FOREVER
    MOVE a FOR 10ms
    WAIT 50ms
  END
ELSE
  MOVE b FOR 5ms
END
)");
  robot.feed(0, "X", 20);
  robot.feed(130, "X", 5);
  robot.run(1000);
  CHECK(robot.only("command interrupt") ==
        "0 #1 command a MOVE for_=0.010\n50 #2 command a MOVE for_=0.010\n"
        "100 #3 command a MOVE for_=0.010\n130 #4 interrupt r0 by b0\n"
        "130 #4 command b MOVE for_=0.005\n");
}

TEST_CASE("what a response sends before and after a wait runs one after the other") {
  Robot robot(when_near("MOVE a FOR 100ms\nWAIT 20ms\nMOVE a FOR 30ms"));
  robot.feed(0, "X", 20);
  robot.run(1000);
  CHECK(robot.only("command done finished") ==
        "0 #1 command a MOVE for_=0.100\n100 #2 done a\n100 #2 command a MOVE for_=0.030\n"
        "130 #2 done a\n130 #2 finished r0\n");
}

TEST_CASE("STOP drops what waits for its actuator and ends what it does") {
  Robot robot(
      "WHEN near X > 10\nDO\nMOVE a FOR 100ms\nMOVE a FOR 70ms\nMOVE b FOR 90ms\nWAIT 50ms\n"
      "STOP a\nMOVE a FOR 20ms\nEND\n");
  robot.feed(0, "X", 20);
  robot.run(1000);
  CHECK(robot.only("command cancel done finished") ==
        "0 #1 command a MOVE for_=0.100\n0 #1 command b MOVE for_=0.090\n"
        "50 #2 cancel a\n50 #2 command a STOP\n50 #2 done a\n50 #2 command a MOVE for_=0.020\n"
        "70 #2 done a\n90 #2 done b\n90 #2 finished r0\n");
}

TEST_CASE(
    "STOP is obeyed although all places for commands are taken by what waits for its actuator") {
  Robot robot("WHEN near X > 10\nDO\n" + repeated("MOVE a FOR 100ms\n", 8) +
              "WAIT 10ms\nMOVE a FOR 100ms\nWAIT 10ms\nSTOP a\nWAIT 1s\nMOVE a FOR 30ms\nEND\n");
  robot.feed(0, "X", 20);
  robot.run(3000);
  CHECK(robot.only("command cancel done overrun") ==
        "0 #1 command a MOVE for_=0.100\n20 #3 cancel a\n20 #3 command a STOP\n20 #3 done a\n"
        "1020 #4 command a MOVE for_=0.030\n1050 #4 done a\n");
}

TEST_CASE("STOP is obeyed although others have taken all places for commands") {
  const std::string others = "MOVE bc FOR 1s\nMOVE d FOR 1s\n";  // of 24 places 8, 8 and 8
  Robot robot("WHEN near X > 10\nDO\nMOVE a FOR 500ms\n" + repeated(others, 7) + "WAIT 10ms\n" +
              repeated(others, 2) + "WAIT 10ms\nSTOP a\nEND\n");
  robot.feed(0, "X", 20);
  robot.run(25);
  CHECK(robot.only("cancel overrun") == "20 #3 cancel a\n");
  CHECK(robot.only("command").ends_with("20 #3 command a STOP\n"));
}

TEST_CASE("what stands behind a STOP takes places again, and only the last STOP counts") {
  Robot robot(
      "WHEN near X > 10\nDO\nMOVE a FOR 100ms\nWAIT 10ms\nMOVE a FOR 70ms\nSTOP a\nMOVE a FOR "
      "60ms\n"
      "STOP a\nMOVE a FOR 20ms\nEND\n");
  robot.feed(0, "X", 20);
  robot.run(1000);
  CHECK(robot.only("command cancel done finished") ==
        "0 #1 command a MOVE for_=0.100\n10 #2 cancel a\n10 #2 command a STOP\n10 #2 done a\n"
        "10 #2 command a MOVE for_=0.020\n30 #2 done a\n30 #2 finished r0\n");
}

TEST_CASE("eight commands wait behind a STOP that found all places taken") {
  const std::string moves = repeated("MOVE a FOR 10ms\n", 8);
  Robot robot("WHEN near X > 10\nDO\n" + moves + "WAIT 5ms\nMOVE a FOR 10ms\nSTOP a\n" + moves +
              "END\n");
  robot.feed(0, "X", 20);
  robot.run(1000);
  CHECK(robot.only("cancel overrun finished") == "5 #2 cancel a\n85 #2 finished r0\n");
}
