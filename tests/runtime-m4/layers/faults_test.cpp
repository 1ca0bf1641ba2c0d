// Threads that are stopped by a fault: what stops with them, what continues, and what the safety
// monitor does when nothing continues.
#include <string_view>
#include <utility>

#include <catch2/catch.hpp>

#include "tests/runtime-m4/interrupts.hpp"
#include "tests/runtime-m4/peer.hpp"
#include "tests/runtime-m4/rig.hpp"
#include "tests/runtime-m4/robot.hpp"

using namespace robosync;
using robosync::test::Rig;

namespace {

const char* const kRobot = R"({
  "sensors": [
    {"name": "touch", "type": "I2C", "bus": 0, "address": "0x70", "device": "max34451",
     "channels": {"LEVEL": {"input": 2, "range": [0, 100], "rate": "50Hz"}}},
    {"name": "near", "type": "VIRTUAL", "channels": {"X": {"range": [0, 100]}}}],
  "actuators": [
    {"name": "arm", "type": "PWM", "pin": 3, "device": "servo", "range": ["0deg", "100deg"],
     "on_release": "hold", "safe": "coast"},
    {"name": "lamp", "type": "PWM", "pin": 4, "device": "pwm", "on_release": "hold", "safe": "rest"}]
})";

const char* const kProgram = R"(
BEHAVIOR high PRIORITY 20
  WHEN near X > 10
  DO MOVE arm TO 100deg AT 10deg/s
  END
END
BEHAVIOR low PRIORITY 10
  WHEN near X > 20 OR touch LEVEL > 50
  DO LIGHT lamp TO 50%
  END
END
)";

std::string_view running(Rig& rig) {
  return rig.kernel.current().name();
}

void start(Rig& rig) {
  REQUIRE(rig.activate(test::compile(kProgram, kRobot)).ok());
  rig.run(0);
}

}  // namespace

TEST_CASE("a stopped behaviour loses its response, the others react as before") {
  Rig rig;
  start(rig);
  rig.feed(1, 15);
  rig.run(1000);
  rig.kernel.stop(rig.thread("high"));
  rig.run(1100);
  CHECK(rig.board.pwm_read(3) == 700);  // held at 10 deg
  rig.feed(1, 30);
  rig.run(2000);
  CHECK(rig.board.pwm_read(3) == 700);
  CHECK(rig.board.pwm_read(4) == 10'000);
  CHECK(rig.only("fault interrupt cancel fire") ==
        "0 #1 fire r0 DO\n1000 #1 fault\n1000 #2 interrupt r0 by b0\n1000 #2 cancel arm\n"
        "1100 #3 fire r1 DO\n");
  CHECK(rig.status().faults == 1);
}

TEST_CASE("a stopped actuator goes to its safe state, and its rule finishes") {
  Rig rig;
  start(rig);
  rig.feed(1, 15);
  rig.run(1000);
  rig.kernel.stop(rig.thread("arm"));
  rig.run(1001);
  CHECK(rig.board.pwm_read(3) == 0);
  rig.feed(1, 0);
  rig.run(1100);
  rig.feed(1, 30);  // the rule fires again; its command has no effect, and nothing waits for it
  rig.run(3000);
  CHECK(rig.board.pwm_read(3) == 0);
  CHECK(rig.board.pwm_read(4) == 10'000);
  CHECK(rig.only("finished") == "1000 #1 finished r0\n1100 #3 finished r0\n1100 #3 finished r1\n");
}

TEST_CASE("what a stopped sensor measured is unknown, with or without an age limit") {
  Rig rig;
  start(rig);
  rig.feed(1, 5);
  rig.run(100);
  rig.kernel.stop(rig.thread("feeds"));
  rig.run(200);
  CHECK(rig.only("stale") == "100 #2 stale X\n");
}

TEST_CASE("a hung program is halted into its safe state and the watchdog is left alone") {
  Rig rig;
  start(rig);
  rig.feed(1, 30);
  rig.run(1000);
  CHECK(rig.board.pwm_read(3) == 700);
  CHECK(rig.board.pwm_read(4) == 10'000);
  const unsigned kicks = rig.board.kicks;
  rig.kernel.stop(rig.thread("step"));
  rig.run(1040);
  CHECK(rig.board.pwm_read(3) != 0);
  CHECK(rig.board.kicks == kicks + 4);
  rig.run(1050);
  CHECK(rig.board.pwm_read(3) == 0);
  CHECK(rig.board.pwm_read(4) == 0);
  rig.run(3000);
  CHECK(rig.board.kicks == kicks + 4);
  CHECK(rig.board.pwm_read(3) == 0);  // the arm's thread was in a movement and sends nothing more
  CHECK(rig.only("deadline done") == "0 #1 done lamp\n1050 #1 deadline 50000\n");
  CHECK(rig.status().safety_checks == 301);

  SECTION("a new program starts over") {
    REQUIRE(rig.activate(test::compile(kProgram, kRobot)).ok());
    rig.feed(1, 15);
    rig.run(4000);
    CHECK(rig.board.kicks == kicks + 4 + 101);
    CHECK(rig.board.pwm_read(3) == 700);
    CHECK(rig.status().faults == 1);
  }
}

TEST_CASE("a program that hung stays halted, whatever its SAFETY rules let go") {
  Rig rig;
  const auto image = test::compile(
      "SAFETY too_near\n  WHEN near X > 90\n  DO STOP lamp\n  RESUME WHEN near X < 50\nEND\n"
      "EVERY 20ms\nDO LIGHT lamp TO 70%\nEND\n",
      kRobot);
  REQUIRE(rig.activate(image).ok());
  rig.run(10);
  rig.feed(0, 20);
  rig.run(200);
  REQUIRE(rig.board.pulse(4) == 14'000);
  bool hangs = true;  // the step thread, longer than a hang, but not long enough for the watchdog
  rig.on_event = [&] {
    if (running(rig) != "step" || !std::exchange(hangs, false)) return;
    rig.kernel.sleep_until(rig.kernel.now() + 70'000);
  };
  rig.run(400);
  REQUIRE_FALSE(hangs);
  CHECK(rig.board.pulse(4) == 0);
  rig.feed(0, 95);
  rig.run(500);
  rig.feed(0, 20);
  rig.run(1000);
  CHECK(rig.board.pulse(4) == 0);
  rig.runtime.stop();
  rig.run(1100);
  rig.runtime.resume();
  rig.run(1500);
  CHECK(rig.board.pulse(4) == 0);
  CHECK(rig.only("release").empty());

  REQUIRE(rig.activate(image).ok());
  rig.feed(0, 20);
  rig.run(2000);
  CHECK(rig.board.pulse(4) == 14'000);
}

namespace {

// Two responses of one behaviour run in one step.
const char* const kTwoResponses = R"(
BEHAVIOR high PRIORITY 20
  WHEN near X > 99
  DO MOVE arm TO 100deg
  END
END
BEHAVIOR low PRIORITY 5
  WHEN near X > 80
  DO LIGHT lamp TO 50%
  END
  WHEN near X > 85
  DO LIGHT second TO 70%
  END
END
)";
const char* const kThreeOutputs = R"({
  "sensors": [{"name": "near", "type": "VIRTUAL", "channels": {"X": {"range": [0, 100]}}}],
  "actuators": [
    {"name": "arm", "type": "PWM", "pin": 3, "device": "servo", "range": ["0deg", "100deg"]},
    {"name": "lamp", "type": "PWM", "pin": 4, "device": "pwm", "on_release": "hold"},
    {"name": "second", "type": "PWM", "pin": 5, "device": "pwm", "on_release": "hold"}]
})";
constexpr std::uint32_t kRest = 2;  // kernel/calls.def

// That program, before anything is near.
struct TwoResponses {
  TwoResponses() {
    REQUIRE(rig.activate(test::compile(kTwoResponses, kThreeOutputs)).ok());
    rig.run(5);
    rig.feed(0, 20);
    rig.run(120);
  }
  Rig rig;
  test::Interrupts interrupts;
};

}  // namespace

TEST_CASE(
    "a fault between the end of a behaviour's task and its rest does not lose its next task") {
  for (unsigned place = 1; place <= 3; ++place) {
    CAPTURE(place);
    TwoResponses scene;
    Rig& rig = scene.rig;
    test::Interrupts& interrupts = scene.interrupts;
    unsigned rests = 0;
    interrupts.before_call = [&](std::uint32_t number) {
      if (number == kRest && running(rig) == "low" && ++rests == place)
        rig.kernel.stop(rig.thread("arm"));
    };
    rig.feed(0, 95);
    rig.run(400);
    CHECK(rests == 3);
    CHECK(rig.board.pulse(4) == 10'000);
    CHECK(rig.board.pulse(5) == 14'000);
    CHECK(rig.only("deadline").empty());
    CHECK(rig.board.kicks == rig.status().safety_checks);
  }
}

TEST_CASE("a response has no effect if its behaviour is stopped before it rests, whoever listens") {
  const bool heard = GENERATE(false, true);
  CAPTURE(heard);
  Rig rig;
  test::Interrupts interrupts;
  start(rig);
  rig.listen(heard);
  interrupts.before_call = [&](std::uint32_t number) {
    if (number == kRest && running(rig) == "low") rig.kernel.stop(rig.thread("low"));
  };
  rig.feed(1, 30);
  rig.run(1000);
  CHECK(rig.status().faults == 1);
  CHECK(rig.board.pwm_read(3) == 700);  // the other behaviour's
  CHECK(rig.board.pulse(4) == 0);
}

TEST_CASE("a damaged behaviour sets no variable that is not its own") {
  Rig rig;
  test::Interrupts interrupts;
  const auto image = test::compile(R"(
REMEMBER n = 0
REMEMBER m = 0
BEHAVIOR high PRIORITY 20
  WHEN near X > 10
  DO SET n TO 7
  END
END
BEHAVIOR low PRIORITY 10
  WHEN m > 5
  DO LIGHT lamp TO 50%
  END
END
)",
                                   kThreeOutputs);
  REQUIRE(rig.activate(image).ok());
  rig.run(0);
  interrupts.before_call = [&](std::uint32_t number) {
    if (number == kRest && running(rig) == "high") RuntimePeer::result(rig.runtime).assigned = ~0U;
  };
  rig.feed(0, 20);
  rig.run(100);
  CHECK(rig.only("set") == "1 #3 set n 7\n");
}

TEST_CASE("a damaged behaviour that rests in the middle of its task is stopped, the others go on") {
  const bool reports = GENERATE(false, true);
  CAPTURE(reports);
  TwoResponses scene;
  Rig& rig = scene.rig;
  test::Interrupts& interrupts = scene.interrupts;
  bool done = false;
  interrupts.before_call = [&](std::uint32_t number) {
    if (number != kRest || running(rig) != "low" || std::exchange(done, true)) return;
    RuntimePeer::finished(rig.runtime) = false;
    if (!reports) rig.kernel.wait(1U << 31U);
  };
  rig.feed(0, 95);
  rig.run(160);
  CHECK(done);
  CHECK(rig.status().faults == 1);
  rig.feed(0, 100);
  rig.run(2000);
  CHECK(rig.board.pulse(3) != 0);
  CHECK(rig.only("deadline").empty());
  CHECK(rig.board.kicks == rig.status().safety_checks);
}

TEST_CASE("long waiting and much work are not hanging") {
  Rig rig;
  start(rig);
  rig.run(60'000);
  for (int i = 0; i < 2000; ++i) {
    rig.feed(1, i % 40);
    rig.run(60'001 + static_cast<std::uint64_t>(i));
  }
  CHECK(rig.only("deadline").empty());
  CHECK(rig.board.kicks == rig.status().safety_checks);
}

TEST_CASE("a behaviour that says its rule wants the ELSE that it has not gets nothing") {
  Rig rig;
  REQUIRE(rig.activate(test::compile("WHILE near X > 10\nDO WAIT 10s\nEND\n", kRobot)).ok());
  rig.run(0);
  rig.feed(0, 15);
  rig.run(10);
  RuntimePeer::judgement(rig.runtime, 0).trigger = layers::Trigger::otherwise;
  rig.feed(0, 18);
  rig.run(1000);
  CHECK(rig.only("input win lose interrupt fault") ==
        "0 #1 input X 15\n0 #1 win r0 DO\n10 #2 input X 18\n");
}

TEST_CASE("a response that says it went on long ago goes on once a millisecond at most") {
  using robosync::vm::Pause;
  const Pause pause = GENERATE(Pause::until_time, Pause::until_done, Pause::polling,
                               Pause::still_polling, Pause::satisfied);
  CAPTURE(static_cast<int>(pause));
  unsigned runs = 0;
  constexpr unsigned kTooMany = 10'000;  // then it tells the truth, so that the test ends
  robosync::test::let_responses_lie([&](robosync::vm::Progress& progress) {
    if (progress.pause == Pause::ended || ++runs > kTooMany) return;
    progress.pause = pause;
    progress.wake = 0;
  });
  robosync::test::Robot robot(
      robosync::test::when_near("REPEAT FOREVER\nWAIT UNTIL far Y > 50 WITHIN 5ms\nWAIT 2ms\nEND"));
  robot.feed(0, "X", 20);
  robot.run(100);
  robosync::test::let_responses_lie({});
  CHECK(runs > 3);
  CHECK(runs <= 101);
}
