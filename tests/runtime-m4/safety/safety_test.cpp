// SAFETY rules: what halts, when, for how long, and the effect of a halted actuator on everything else.
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "runtime-m4/layers/safety_region.hpp"
#include "tests/runtime-m4/interrupts.hpp"
#include "tests/runtime-m4/rig.hpp"
#include "tests/runtime-m4/robot.hpp"

namespace vm = robosync::vm;
using robosync::layers::SafetyRegion;
using robosync::test::Rig;
using robosync::test::Robot;

namespace {

const char* const kGuarded = R"(
SAFETY pinch
  WHEN far Y > 15
  DO
    STOP a
    ALERT "too much"
  RESUME WHEN far Y < 5
END
BEHAVIOR wave PRIORITY 20
  WHEN near X > 10
  DO
    MOVE a FOR 1s
    MOVE b FOR 1s
  END
END
)";

std::vector<std::byte> guarded_with_stale_after(const std::string& time) {
  return robosync::test::compile(
      kGuarded,
      R"({"sensors": [{"name": "near", "type": "VIRTUAL", "channels": {"X": {"range": [0, 100]}}},
                   {"name": "far", "type": "VIRTUAL",
                    "channels": {"Y": {"range": [0, 100], "stale_after": ")" +
          time + R"("}}}],
       "actuators": [{"name": "a", "type": "VIRTUAL"}, {"name": "b", "type": "VIRTUAL"}]})");
}

}  // namespace

TEST_CASE("a trip halts at once, its owner is interrupted in the step that the reading enters") {
  Robot robot(kGuarded);
  robot.feed(0, "Y", 2);
  robot.feed(0, "X", 20);
  robot.feed(500, "Y", 18);
  robot.run(2000);
  CHECK(robot.only("trip halt alert interrupt cancel command done finished") ==
        "0 #1 command a MOVE for_=1\n0 #1 command b MOVE for_=1\n"
        "500 #1 trip r0\n500 #1 halt a\n500 #1 alert \"too much\"\n"
        "500 #2 interrupt r2 by b0\n500 #2 cancel a\n500 #2 cancel b\n");
}

TEST_CASE("claims on a halted actuator lose until the rule lets go, which it does only when safe") {
  Robot robot(kGuarded);
  robot.feed(0, "Y", 2);
  robot.feed(100, "Y", 18);
  robot.feed(200, "X", 20);
  robot.feed(300, "Y", 10);  // no danger, but not safe enough to resume
  robot.feed(400, "X", 0);
  robot.feed(500, "X", 20);
  robot.feed(600, "Y", 4);
  robot.feed(700, "X", 0);
  robot.feed(800, "X", 20);
  robot.run(1000);
  CHECK(robot.only("trip halt resume release win lose") ==
        "100 #1 trip r0\n100 #1 halt a\n200 #3 lose r2 DO to b0\n500 #6 lose r2 DO to b0\n"
        "600 #6 resume r0\n600 #6 release a\n800 #9 win r2 DO\n");
}

TEST_CASE("what is unknown trips before the first step; a reading at once is in time") {
  Robot robot(kGuarded);
  robot.feed(0, "X", 20);
  robot.feed(100, "Y", 2);
  robot.run(1000);
  CHECK(robot.only("trip halt resume release win lose") ==
        "0 #0 trip r0\n0 #0 halt a\n0 #1 lose r2 DO to b0\n100 #1 resume r0\n100 #1 release a\n");

  Robot measured(kGuarded);
  measured.feed(0, "Y", 2);
  measured.feed(0, "X", 20);
  measured.run(1000);
  CHECK(measured.only("trip win") == "0 #1 win r2 DO\n");
}

namespace {

// A program with kGuarded's rule, on a sensor that is sampled every 20 ms, and an actuator that moves immediately.
const char* const kSampled = R"({
  "sensors": [{"name": "far", "type": "I2C", "device": "i2c_register", "address": "0x10",
               "channels": {"Y": {"range": [0, 100], "rate": "50Hz", "unit": "%"}}}],
  "actuators": [{"name": "a", "type": "VIRTUAL"}],
  "safety": {"start": "70ms"}})";
const char* const kAtStart =
    "SAFETY pinch\n  WHEN far Y > 15\n  DO STOP a\n  RESUME WHEN far Y < 5\nEND\n"
    "AT START DO MOVE a FOR 1s\nEND\n";

}  // namespace

TEST_CASE("on a robot the program begins with the first reading, or when the time for it is over") {
  const auto image = robosync::test::compile(kAtStart, kSampled);
  Rig silent;
  REQUIRE(silent.activate(image).ok());
  silent.run(69);
  CHECK(silent.only("trip win lose").empty());
  CHECK(silent.status().program_us == 0);
  silent.run(500);
  CHECK(silent.only("trip win lose") == "0 #0 trip r0\n0 #1 lose r2 DO to b0\n");
  CHECK(silent.status().program_us == 430'000);

  Rig measured;
  measured.board.answers.assign(1000, std::byte{0});
  REQUIRE(measured.activate(image).ok());
  measured.run(500);
  CHECK(measured.only("trip win lose") == "0 #1 win r2 DO\n");
  CHECK(measured.status().program_us == 500'000);
}

TEST_CASE(
    "the watchdog is kicked in time, whenever a program comes that waits for what SAFETY reads") {
  const auto image = robosync::test::compile(kGuarded, robosync::test::kPlainRobot);
  for (std::uint64_t first = 1; first <= 35; ++first) {
    Rig rig;
    unsigned kicks = 0;
    std::uint64_t kicked = 0, longest = 0;
    for (std::uint64_t ms = 0; ms < 400; ++ms) {
      if (ms == first || ms == first + 100 + first % 10) REQUIRE(rig.activate(image).ok());
      rig.run(ms);
      if (rig.board.kicks != kicks) kicked = ms;
      kicks = rig.board.kicks;
      longest = std::max(longest, ms - kicked);
    }
    CAPTURE(first);
    CHECK(longest <= 30);  // its first time-out comes after 50
  }
}

TEST_CASE("without a program the watchdog is kicked as often as it needs, with a third to spare") {
  for (const std::uint32_t first_time_out_ms : {50U, 100U}) {
    Rig rig;
    rig.board.first_time_out_ms = first_time_out_ms;
    std::uint64_t kicked = 0, longest = 0, shortest = first_time_out_ms;
    unsigned kicks = 0;
    for (std::uint64_t ms = 0; ms < 1000; ++ms) {
      rig.run(ms);
      if (rig.board.kicks == kicks) continue;
      kicks = rig.board.kicks;
      longest = std::max(longest, ms - kicked);
      if (kicked != 0) shortest = std::min(shortest, ms - kicked);
      kicked = ms;
    }
    CAPTURE(first_time_out_ms);
    CHECK(longest * 3 <= first_time_out_ms * 2);
    CHECK(shortest * 2 >= first_time_out_ms);
  }
}

TEST_CASE("a robot begins when what is fed has come, and feeds keep their program times") {
  const auto image = robosync::test::compile(kGuarded, robosync::test::kPlainRobot);
  Rig rig;
  REQUIRE(rig.activate(image).ok());
  REQUIRE(rig.feed(0, 20, 300) == robosync::link::FeedError::none);
  rig.run(40);
  REQUIRE(rig.feed(1, 2) == robosync::link::FeedError::none);
  rig.run(500);
  CHECK(rig.only("trip win") == "300 #2 win r2 DO\n");
  CHECK(rig.status().program_us == 460'000);
}

TEST_CASE("when a silent sensor trips does not depend on when the program began") {
  const auto image = guarded_with_stale_after("203ms");
  for (const bool after_another : {false, true}) {
    for (unsigned phase = 0; phase < 35; ++phase) {
      INFO("it begins after " << phase << " ms");
      Rig rig;
      if (after_another) REQUIRE(rig.activate(image).ok());
      rig.run(phase);
      REQUIRE(rig.activate(image).ok());
      rig.lines.clear();
      rig.feed(1, 2, 3);
      rig.feed(0, 1, 208);  // the rule does not read this, so it is not checked
      rig.run(phase + 1000);
      CHECK(rig.only("trip") == "0 #0 trip r0\n210 #3 trip r0\n");
    }
  }
}

TEST_CASE("a pin that may not change at once goes on by itself until it is there") {
  constexpr std::uint16_t kSlow = 32;
  Rig rig;
  REQUIRE(rig.activate(robosync::test::compile(
                           "WHEN near X > 10\nDO MOVE arm TO 100deg\nELSE MOVE arm TO 0deg\nEND\n",
                           R"({"sensors": [{"name": "near", "type": "VIRTUAL",
                                            "channels": {"X": {"range": [0, 100]}}}],
                               "actuators": [{"name": "arm", "type": "PWM", "pin": 32, "device": "servo",
                                              "range": ["0deg", "100deg"]}]})"))
              .ok());
  rig.feed(0, 20);
  rig.run(1000);
  CHECK(rig.board.pwm_read(kSlow) == 2000);
  rig.feed(0, 0);
  rig.run(1100);
  CHECK(rig.board.pwm_read(kSlow) > 1700);
  rig.run(3000);
  CHECK(rig.board.pwm_read(kSlow) == 1000);
}

// The step thread would notice that the reading is too old; SAFETY does not wait for it.
TEST_CASE("a silent sensor trips although no step comes") {
  const auto image = guarded_with_stale_after("20ms");
  Rig rig;
  REQUIRE(rig.activate(image).ok());
  rig.feed(1, 2);
  rig.run(10);
  rig.kernel.stop(rig.thread("step"));
  rig.run(45);
  CHECK(rig.only("trip") == "30 #1 trip r0\n");
}

// The safety thread outranks the one that serves fed readings, and delivers them first.
TEST_CASE("what is fed at the moment at which it would be too old comes in time") {
  Rig rig;
  REQUIRE(rig.activate(guarded_with_stale_after("29ms")).ok());
  rig.feed(1, 2);
  rig.feed(1, 2, 30);
  rig.run(59);
  CHECK(rig.only("trip").empty());
  rig.run(60);
  CHECK(rig.only("trip") == "60 #1 trip r0\n");
}

TEST_CASE("of two sensors that fall silent each trips its rule when it is too old") {
  Rig rig;
  REQUIRE(rig.activate(robosync::test::compile("SAFETY one\n  WHEN near X > 15\n  DO STOP a\nEND\n"
                                               "SAFETY two\n  WHEN far Y > 15\n  DO STOP a\nEND\n",
                                               R"({"sensors": [{"name": "near", "type": "VIRTUAL",
                                            "channels": {"X": {"range": [0, 100], "stale_after": "20ms"}}},
                                           {"name": "far", "type": "VIRTUAL",
                                            "channels": {"Y": {"range": [0, 100], "stale_after": "50ms"}}}],
                               "actuators": [{"name": "a", "type": "VIRTUAL"}]})"))
              .ok());
  rig.feed(0, 2);
  rig.feed(1, 2);
  rig.run(200);
  CHECK(rig.only("trip") == "30 #2 trip r0\n60 #3 trip r1\n");
}

namespace {

const char* const kMotorAndFan = R"({
  "sensors": [{"name": "near", "type": "VIRTUAL", "channels": {"X": {"range": [0, 100]}}},
              {"name": "far", "type": "VIRTUAL", "channels": {"Y": {"range": [0, 100]}}},
              {"name": "wall", "type": "I2C", "device": "i2c_register", "address": "0x10",
               "channels": {"Z": {"range": [0, 100], "rate": "50Hz", "unit": "%"}}}],
  "actuators": [{"name": "motor", "type": "PWM", "pin": 4, "device": "pwm", "on_release": "hold"},
                {"name": "fan", "type": "PWM", "pin": 6, "device": "pwm", "on_release": "hold"}],
  "safety": {"start": "90ms"}})";

}  // namespace

// Its rules are not evaluated before their readings are known, so nothing would stop a motor meanwhile.
TEST_CASE("a motor that runs at an upload stands still until the rules of the next program know") {
  Rig rig;
  REQUIRE(
      rig.activate(robosync::test::compile("AT START\nDO RUN motor TO 70%\nEND\n", kMotorAndFan))
          .ok());
  rig.run(1000);
  REQUIRE(rig.board.pulse(4) == 14'000);
  REQUIRE(rig.activate(robosync::test::compile(
                           "SAFETY pinch\n  WHEN near X > 90 OR far Y > 90\n  DO STOP motor\n"
                           "  RESUME WHEN near X < 50\nEND\n"
                           "WHEN near X < 80\nDO RUN motor TO 20%\nEND\n",
                           kMotorAndFan))
              .ok());
  CHECK(rig.board.pulse(4) == 0);
  rig.feed(0, 10);
  rig.run(1050);
  CHECK(rig.board.pulse(4) == 0);
  rig.feed(1, 10);
  rig.run(1100);
  CHECK(rig.board.pulse(4) == 4'000);
}

// A tick while the thread that brings the reading wakes SAFETY makes the step thread ready, which must not overtake it.
TEST_CASE("no step begins with a reading that SAFETY has not seen, whenever the tick comes") {
  const bool fed = GENERATE(false, true);
  CAPTURE(fed);
  const std::string channel = fed ? "near X" : "wall Z";
  Rig rig;
  robosync::test::Interrupts interrupts;
  int level = 20;  // percent
  rig.board.on_transfer = [&](std::span<const std::byte>, std::span<std::byte> in) {
    const auto raw = static_cast<std::uint16_t>(level);
    if (in.size() == 2) in[0] = static_cast<std::byte>(raw), in[1] = std::byte{0};
    return true;
  };
  REQUIRE(rig
              .activate(robosync::test::compile(
                  "SAFETY pinch\n  WHEN " + channel + " > 90\n  DO STOP motor\n  RESUME WHEN " +
                      channel + " < 50\nEND\nWHEN " + channel +
                      " > 80\nDO\n  RUN motor TO 100%\n  RUN fan TO 100%\nEND\n"
                      "EVERY 7ms\nDO LOG \"tick\"\nEND\n",
                  kMotorAndFan))
              .ok());
  rig.run(5);
  rig.feed(0, 20);
  rig.run(10);
  const std::uint64_t begin = (rig.kernel.now() - rig.status().program_us) / 1000;
  rig.run(begin + 159);
  REQUIRE(rig.only("trip").empty());
  bool ticked = false;
  interrupts.before_signal = [&](const robosync::kernel::Thread& thread) {
    const std::string_view by = rig.kernel.current().name();
    const std::string_view to = thread.name();
    if (ticked || to != "safety" || (by != "feeds" && by != "wall")) return;
    ticked = true;
    rig.kernel.on_tick(1);
  };
  level = 95;
  if (fed) rig.run(begin + 160);
  rig.feed(0, 95);
  rig.run(begin + 200);  // the wall is measured at 160, EVERY is due at 161
  CHECK(ticked);
  CHECK(rig.only("trip").find("trip r0") != std::string::npos);
  const std::string claims = rig.only("win lose");
  CHECK(claims.find("lose r2 DO to b0") != std::string::npos);
  CHECK(claims.find("win r2") == std::string::npos);
  CHECK(rig.board.pulse(6) == 0);
}

TEST_CASE("a rule stays tripped as long as it is in danger, whatever its RESUME WHEN says") {
  Robot robot(R"(
SAFETY pinch
  WHEN far Y > 15
  DO STOP a
  RESUME WHEN far Y > 10
END
)");
  robot.feed(0, "Y", 2);
  robot.feed(100, "Y", 18);
  robot.feed(300, "Y", 12);
  robot.run(500);
  CHECK(robot.only("trip resume") == "100 #1 trip r0\n300 #2 resume r0\n");
}

TEST_CASE("two rules that halt the same: it is let go when both have") {
  Robot robot(R"(
SAFETY first
  WHEN far Y > 15
  DO STOP a
  RESUME WHEN far Y < 5
END
SAFETY other
  WHEN near X > 50
  DO STOP ALL
  RESUME WHEN near X < 40
END
WHEN far Y > 90
DO
  MOVE a
  MOVE b
END
)");
  robot.feed(0, "X", 0);
  robot.feed(0, "Y", 0);
  robot.feed(100, "X", 60);
  robot.feed(200, "Y", 20);
  robot.feed(300, "X", 0);
  robot.feed(400, "Y", 0);
  robot.run(1000);
  std::string seen;
  for (const std::string& line : robot.lines())
    if (line.find("halt") != std::string::npos || line.find("release") != std::string::npos)
      seen += line.substr(0, 4) + line.substr(line.find(' ', line.find('#')) + 1) + ", ";
  CHECK(seen ==
        "100 halt a, 100 halt b, 100 halt c, 100 halt d, "
        "300 release b, 300 release c, 300 release d, 400 release a, ");
}

TEST_CASE("without RESUME WHEN it stays tripped; a new program clears it") {
  const auto image = robosync::test::compile(
      "SAFETY pinch\n  WHEN near X > 15\n  DO STOP a\nEND\n"
      "WHEN near X < 10\nDO MOVE a\nEND\n",
      robosync::test::kPlainRobot);
  Rig rig;
  REQUIRE(rig.activate(image).ok());
  rig.feed(0, 20);
  rig.run(100);
  rig.feed(0, 5);
  rig.run(5000);
  CHECK(rig.only("trip resume win") == "0 #0 trip r0\n");
  REQUIRE(rig.activate(image).ok());
  rig.feed(0, 5);
  rig.run(6000);
  CHECK(rig.only("trip resume win") == "0 #0 trip r0\n0 #1 win r1 DO\n");
}

TEST_CASE("RESUME WHEN with FOR counts from the last time it was not so") {
  Robot robot(R"(
SAFETY hot
  WHEN far Y > 60 MARGIN 5
  DO
    STOP a
    LOG "hot at ", far Y
  RESUME WHEN far Y < 45 FOR 300ms
END
WHEN near X > 10
DO MOVE a
END
)");
  robot.feed(0, "Y", 20);
  robot.feed(100, "Y", 70);
  robot.feed(200, "Y", 40);
  robot.feed(400, "Y", 50);
  robot.feed(600, "Y", 40);
  robot.run(2000);
  CHECK(robot.only("trip log resume") ==
        "100 #1 trip r0\n100 #1 log \"hot at {%}\" 70\n900 #5 resume r0\n");
}

TEST_CASE("a WHILE that was halted comes back when it may") {
  Robot robot(R"(
SAFETY pinch
  WHEN far Y > 15
  DO STOP a
  RESUME WHEN far Y < 5
END
WHILE near X > 10
DO MOVE a FOR 10s
END
)");
  robot.feed(0, "Y", 2);
  robot.feed(0, "X", 20);
  robot.feed(500, "Y", 18);
  robot.feed(900, "Y", 1);
  robot.run(2000);
  CHECK(robot.only("win lose interrupt trip resume") ==
        "0 #1 win r2 DO\n500 #1 trip r0\n500 #2 interrupt r2 by b0\n900 #2 resume r0\n"
        "900 #3 win r2 DO\n");
}

TEST_CASE("what a safety rule sets enters a step of its own") {
  Robot robot(R"(
STATE mood: calm, scared
SAFETY pinch
  WHEN far Y > 15
  DO SET mood TO scared
  RESUME WHEN far Y < 5
END
WHEN mood IS scared
DO LOG "scared"
END
)");
  robot.feed(0, "Y", 2);
  robot.feed(500, "Y", 18);
  robot.run(1000);
  std::string seen;
  for (const std::string& line : robot.lines())
    if (line.find(" set ") != std::string::npos || line.find(" log ") != std::string::npos)
      seen += line.substr(0, 4) + line.substr(line.find(' ', line.find('#')) + 1) + ", ";
  CHECK(seen == "500 set mood 1, 500 log \"scared\", ");
}

namespace {

// The word of a rule's body that halts, in memory.
vm::Word& halt_of(const vm::Image& image, unsigned rule) {
  const vm::Response& body = image.responses[image.rules[rule].then_response];
  for (const vm::Word& word : image.code.subspan(body.start, body.length))
    if (vm::opcode_of(word) == vm::Opcode::halt) return const_cast<vm::Word&>(word);
  FAIL("it halts nothing");
  return const_cast<vm::Word&>(image.code[0]);
}

}  // namespace

// SAFETY's bytecode is not trusted either: the actuators that a rule halts were determined when it was verified. Here its
// code is damaged afterwards.
TEST_CASE("a tripped rule halts nothing that the verified one did not") {
  Rig rig;
  REQUIRE(rig.activate(robosync::test::compile("SAFETY one\n  WHEN near X > 15\n  DO STOP a\nEND\n"
                                               "SAFETY two\n  WHEN far Y > 15\n  DO STOP b\nEND\n"
                                               "WHEN near X > 10\nDO MOVE b\nEND\n",
                                               robosync::test::kPlainRobot))
              .ok());
  vm::Word& first = halt_of(rig.runtime.image(), 0);
  const vm::Word second = halt_of(rig.runtime.image(), 1);
  REQUIRE(first != second);
  first = second;
  rig.feed(0, 2);
  rig.feed(1, 2);
  rig.run(100);
  rig.feed(0, 20);
  rig.run(200);
  CHECK(rig.only("trip halt win") == "100 #1 trip r0\n100 #2 win r2 DO\n");
}

TEST_CASE("only what stands in its output was put out by a safety rule's body") {
  const std::array<vm::Word, 6> memory{1, 2, 3, 4, 5, 6};
  const std::span<const vm::Word> output = std::span(memory).subspan(1, 4);
  const auto put_out = [output](std::ptrdiff_t bytes) {
    const auto end =
        reinterpret_cast<std::uintptr_t>(output.data()) + static_cast<std::uintptr_t>(bytes);
    const auto words = SafetyRegion::put_out(output, reinterpret_cast<const vm::Word*>(end));
    return std::vector<vm::Word>(words.begin(), words.end());
  };
  CHECK(put_out(0).empty());
  CHECK(put_out(8) == std::vector<vm::Word>{2, 3});
  CHECK(put_out(16) == std::vector<vm::Word>{2, 3, 4, 5});
  CHECK(put_out(10) == std::vector<vm::Word>{2, 3});
  CHECK(put_out(17).empty());
  CHECK(put_out(20).empty());
  CHECK(put_out(-4).empty());
}
