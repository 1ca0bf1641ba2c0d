// Programs that run for weeks: their milliseconds have 32 bits and wrap after 49.7 days.
#include <algorithm>

#include <catch2/catch.hpp>

#include "tests/runtime-m4/rig.hpp"
#include "tests/runtime-m4/robot.hpp"

using namespace robosync;
using robosync::test::Rig;

namespace {

constexpr std::uint32_t kNineDays = 0x3000'0000;  // in ticks

const char* const kLongRunRobot = R"({
  "sensors": [{"name": "near", "type": "VIRTUAL", "channels": {"X": {"range": [0, 100]}}}],
  "actuators": [{"name": "motor", "type": "PWM", "pin": 4, "device": "pwm", "on_release": "hold"}]
})";

struct LongRun {
  explicit LongRun(const std::string& program) {
    REQUIRE(rig.activate(test::compile(program, kLongRunRobot)).ok());
    go_on(1000);
  }
  void go_on(unsigned ms) { rig.run(rig.kernel.now() / 1000 + ms); }
  // Makes the state the same as if it had run for that long.
  void weeks_pass(std::uint32_t ticks) {
    rig.kernel.on_tick(ticks);
    go_on(1000);
  }
  void feeds(int units) {
    rig.feed(0, units);
    go_on(600);
  }

  Rig rig;
};

}  // namespace

TEST_CASE("SAFETY, EVERY and WAIT go on for weeks") {
  LongRun robot(
      "SAFETY too_near\n  WHEN near X > 90 FOR 200ms\n  DO STOP motor\n  RESUME WHEN near X < "
      "80\nEND\n"
      "EVERY 1s\nDO\n  RUN motor TO 70%\n  WAIT 100ms\n  LOG \"again\"\nEND\n");
  const std::uint32_t each = GENERATE(as<std::uint32_t>(), kNineDays, kNineDays / 3 * 2);
  for (unsigned part = 0; part < 9; ++part) {
    CAPTURE(part);
    robot.feeds(20);
    robot.go_on(2000);
    CHECK(robot.rig.board.pulse(4) == 14'000);
    robot.rig.lines.clear();
    robot.go_on(5000);
    const std::string fired = robot.rig.only("fire");
    CHECK(std::ranges::count(fired, '\n') == 5);
    const std::string gone_on = robot.rig.only("go_on");
    CHECK(std::ranges::count(gone_on, '\n') == 5);
    robot.feeds(95);
    CHECK(robot.rig.board.pulse(4) == 0);
    robot.feeds(20);
    robot.weeks_pass(each);
  }
}

namespace {

constexpr std::uint32_t kADay = 86'400'000;  // in ticks

// Nothing is due and nothing is fed for so long.
void days_pass(LongRun& robot, unsigned days) {
  for (unsigned day = 0; day < days; ++day) {
    robot.rig.kernel.on_tick(kADay);
    robot.go_on(10);
  }
}

}  // namespace

TEST_CASE("a COOLDOWN that is over does not come back after weeks in which nothing happened") {
  const unsigned days = GENERATE(1U, 20U, 30U, 45U, 52U);
  CAPTURE(days);
  LongRun robot("WHEN near X > 50\nCOOLDOWN 20s\nDO RUN motor TO 70%\nEND\n");
  robot.feeds(60);
  robot.feeds(10);
  days_pass(robot, days);
  robot.rig.lines.clear();
  robot.feeds(60);
  const std::string won = robot.rig.only("win");
  CHECK(std::ranges::count(won, '\n') == 1);
}

TEST_CASE("a rule whose WAITING is over does not run weeks later") {
  const unsigned days = GENERATE(1U, 20U, 30U, 45U, 52U);
  CAPTURE(days);
  LongRun robot(
      "BEHAVIOR a PRIORITY 9\nWHEN near X > 80\nDO\n  RUN motor TO 20%\n  WAIT UNTIL near X < "
      "20\nEND\nEND\n"
      "BEHAVIOR b PRIORITY 5\nWHEN near X > 50\nWAITING 2s\nDO RUN motor TO 70%\nEND\nEND\n");
  robot.feeds(90);
  REQUIRE(robot.rig.only("win lose").find("lose r1") != std::string::npos);
  days_pass(robot, days);
  robot.rig.lines.clear();
  robot.feeds(10);
  CHECK(robot.rig.only("win").empty());
  CHECK(robot.rig.board.pulse(4) == 4'000);
}

// All goes on through the last millisecond that a program can count, which is also the mark for no time at all.
namespace {

// Up to `before` milliseconds in front of it; no step comes after that.
void last_millisecond_comes(LongRun& robot, unsigned before) {
  const auto left = [&] {
    link::Status status{};
    robot.rig.runtime.fill_status(status);
    return UINT32_MAX - before - static_cast<std::uint32_t>(status.program_us / 1000);
  };
  while (left() > kADay)
    days_pass(robot, 1);
  robot.rig.kernel.on_tick(left() - 10);
  robot.go_on(10);
}

std::size_t logged(const LongRun& robot) {
  const std::string lines = robot.rig.only("log");
  return static_cast<std::size_t>(std::ranges::count(lines, '\n'));
}

}  // namespace

TEST_CASE("what is due in each millisecond is due in the last one, too") {
  const auto* const body = GENERATE(as<const char*>(), "DO\n  WAIT 1ms\n  LOG \"on\"\nEND",
                                    "DO LOG \"on\" END", "COOLDOWN 1ms\nDO LOG \"on\" END",
                                    "DO\n  RUN motor TO 70%\n  THEN\n  LOG \"on\"\nEND",
                                    "DO\n  WAIT UNTIL near X > 10\n  LOG \"on\"\nEND");
  CAPTURE(body);
  LongRun robot(std::string("WHILE near X > 50\n") + body + "\n");
  last_millisecond_comes(robot, 2000);
  robot.feeds(60);
  robot.rig.lines.clear();
  robot.go_on(1000);
  const std::size_t before = logged(robot);
  robot.go_on(1000);
  robot.rig.lines.clear();
  robot.go_on(1000);
  CHECK(before >= 50);
  CHECK(logged(robot) == before);
}

TEST_CASE("a FEELING fades, and a median moves on, through the last millisecond") {
  const unsigned later = GENERATE(range(0U, 100U));
  CAPTURE(later);
  LongRun fades(
      "FEELING joy FROM 0 TO 100 START 0\n  FADES TO 0 OVER 20s\n"
      "WHEN near X > 50\nDO SET joy TO 100\nEND\nWHEN joy < 60\nDO LOG \"calm\" END\n");
  last_millisecond_comes(fades, 300);
  fades.go_on(later);
  fades.rig.lines.clear();
  fades.rig.feed(0, 60);
  fades.go_on(30'000);
  CHECK(logged(fades) == 1);
  if (later >= 25) return;
  LongRun smooths(
      "CHECK nearness OF near X\n  SMOOTH OVER 200ms\n  close ABOVE 50\n  far OTHERWISE\nEND\n"
      "WHEN nearness IS close\nDO LOG \"close\" END\n");
  smooths.go_on(later);  // its samples are whole periods after the first one
  smooths.feeds(10);
  last_millisecond_comes(smooths, 60);
  smooths.rig.feed(0, 60);
  smooths.go_on(1000);
  CHECK(logged(smooths) == 1);
}

TEST_CASE("what SAFETY sets takes effect at once, however long the program before it ran") {
  const char* const program =
      "REMEMBER bad = 0\n"
      "SAFETY one\n  WHEN near X > 90\n  DO\n    SET bad TO 1\n    STOP motor\n"
      "  RESUME WHEN near X < 50\nEND\nSAFETY two\n  WHEN bad > 0\n  DO STOP motor\nEND\n"
      "WHEN near X > 50\nDO RUN motor TO 70%\nEND\n";
  for (const unsigned before_ms : {0U, 500'500U}) {
    CAPTURE(before_ms);
    Rig rig;
    if (before_ms != 0) {
      REQUIRE(
          rig.activate(test::compile("EVERY 1s\nDO RUN motor TO 10%\nEND\n", kLongRunRobot)).ok());
      rig.run(before_ms);
      rig.lines.clear();
    }
    REQUIRE(rig.activate(test::compile(program, kLongRunRobot)).ok());
    rig.run(before_ms + 3000);
    CHECK(rig.only("trip set") == "0 #0 trip r0\n0 #0 trip r2\n0 #1 set bad 1\n");
  }
}

TEST_CASE("a FEELING that has faded does not come back") {
  LongRun robot(
      "FEELING fear FROM 0% TO 100% START 90% FADES TO 0% OVER 10s\n"
      "WHEN fear > 5% AND near X > 50\nDO RUN motor TO 70%\nEND\n");
  robot.go_on(60'000);
  robot.feeds(20);
  for (unsigned part = 0; part < 8; ++part) {
    CAPTURE(part);
    robot.weeks_pass(0x2000'0000);  // an eighth of 49.7 days: it wraps once
    robot.rig.lines.clear();
    robot.feeds(60);
    CHECK(robot.rig.board.pulse(4) == 0);
    CHECK(robot.rig.only("set fire").empty());
    robot.feeds(20);
  }
}
