// EVERY: periods counted from activation, fixed or random; triggers that come too early are skipped.
#include <catch2/catch.hpp>

#include "tests/runtime-m4/robot.hpp"

using robosync::test::Robot;

TEST_CASE("EVERY triggers each period, the first time one period after activation") {
  Robot robot("EVERY 100ms\nDO MOVE a FOR 10ms\nEND\n");
  robot.run(350);
  CHECK(robot.only("fire command finished") ==
        "100 #2 fire r0 DO\n100 #2 command a MOVE for_=0.010\n110 #2 finished r0\n"
        "200 #3 fire r0 DO\n200 #3 command a MOVE for_=0.010\n210 #3 finished r0\n"
        "300 #4 fire r0 DO\n300 #4 command a MOVE for_=0.010\n310 #4 finished r0\n");
}

TEST_CASE("a period that comes while its response runs is skipped, not queued") {
  Robot robot("EVERY 100ms\nDO MOVE a FOR 150ms\nEND\n");
  robot.run(450);
  CHECK(robot.only("win lose finished") ==
        "100 #2 win r0 DO\n200 #3 lose r0 DO to b0\n250 #3 finished r0\n"
        "300 #4 win r0 DO\n400 #5 lose r0 DO to b0\n450 #5 finished r0\n");
}

TEST_CASE("periods do not drift, whatever else makes steps") {
  Robot robot("EVERY 70ms\nDO LOG \"tick\"\nEND\nWHEN near X > 10\nDO MOVE a\nEND\n");
  for (int i = 0; i < 30; ++i)
    robot.feed(static_cast<std::uint64_t>(i) * 9, "X", i % 5);
  robot.run(300);
  std::string ticks;
  for (const std::string& line : robot.lines())
    if (line.find("log") != std::string::npos) ticks += line.substr(0, line.find(' ')) + " ";
  CHECK(ticks == "70 140 210 280 ");
}

TEST_CASE("a period that is not known is asked for again when it is") {
  Robot robot("BEHAVIOR beat PRIORITY 5\nEVERY near X * 10ms\nDO LOG \"tick\"\nEND\nEND\n");
  robot.feed(50, "X", 10);  // the period begins here, and ends at 150
  robot.feed(155, "X", 2);  // the present one lasts until 250; the next are 20 ms long
  robot.run(280);
  CHECK(robot.only("log") == "150 #3 log \"tick\"\n250 #5 log \"tick\"\n270 #6 log \"tick\"\n");
}

TEST_CASE("a random period lies between its bounds, and is the same in every run") {
  const char* const program = "EVERY 20ms TO 60ms\nDO LOG \"tick\"\nEND\n";
  Robot robot(program);
  robot.run(10'000);
  Robot again(program);
  again.run(10'000);
  CHECK(robot.trace() == again.trace());
  int last = 0;
  int shortest = 1000;
  int longest = 0;
  for (const std::string& line : robot.lines()) {
    if (line.find("log") == std::string::npos) continue;
    const int at = std::stoi(line);
    shortest = std::min(shortest, at - last);
    longest = std::max(longest, at - last);
    last = at;
  }
  CHECK(shortest >= 20);
  CHECK(shortest <= 24);  // of 200 draws from 41
  CHECK(longest <= 60);
  CHECK(longest >= 56);
}

TEST_CASE("AT START runs once, before any reading") {
  Robot robot("AT START DO MOVE a FOR 5ms\nEND\nWHEN near X > 10\nDO MOVE b FOR 5ms\nEND\n");
  robot.feed(10, "X", 20);
  robot.run(100);
  CHECK(robot.only("fire command finished") ==
        "0 #1 fire r0 DO\n0 #1 command a MOVE for_=0.005\n5 #1 finished r0\n"
        "10 #2 fire r1 DO\n10 #2 command b MOVE for_=0.005\n15 #2 finished r1\n");
}
