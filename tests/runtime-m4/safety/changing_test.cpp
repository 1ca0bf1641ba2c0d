// A person's stop and resume, and a hazard, while one program replaces another: they take effect whenever they come.
#include <algorithm>

#include <catch2/catch.hpp>

#include "compiler/config/robot.hpp"
#include "tests/runtime-m4/rig.hpp"
#include "tests/runtime-m4/robot.hpp"

using namespace robosync;
using robosync::test::Rig;

namespace {

constexpr std::uint16_t kArm = 3, kMotor = 4, kSonarEcho = 41;
constexpr kernel::Events kUpload = 1;

std::string outputs_with(const std::string& safe, const std::string& sensors = "") {
  return R"({"sensors": [)" + sensors +
         R"({"name": "near", "type": "VIRTUAL", "channels": {"X": {"range": [0, 100]}}}],
    "actuators": [
      {"name": "arm", "type": "PWM", "pin": 3, "device": "servo", "range": ["0deg", "100deg"], "safe": ")" +
         safe + R"("},
      {"name": "motor", "type": "PWM", "pin": 4, "device": "pwm", "on_release": "hold"}]})";
}

const char* const kChangingProgram =
    "EVERY 50ms\nDO\n  RUN motor TO 70%\nEND\n"
    "AT START\nDO MOVE arm TO 100deg AT 100deg/s\nEND\n";

// Uploads from a thread, as the link does, so that the safety thread preempts it wherever it is signalled.
struct Changing {
  Changing() {
    REQUIRE(kernel.add(link, {.name = "link",
                              .category = kernel::Category::system,
                              .priority = 0,
                              .entry = [](void* self) { static_cast<Changing*>(self)->serve(); },
                              .argument = this,
                              .stack = {}}));
    rig.on_event = board.on_pin = [this] {
      if (++places == act_at && act) act();
    };
  }
  void serve() {
    while (true) {
      kernel.wait(kUpload);
      places = 0;
      is_running = rig.activate(next).ok();
      last = places;
      places = 1U << 31U;  // stops counting
    }
  }
  void go_on(unsigned ms) { rig.run(kernel.now() / 1000 + ms); }
  void upload(const std::vector<std::byte>& program) {
    next = program;
    kernel.signal(link, kUpload);
    go_on(1);
    REQUIRE(is_running);
  }
  bool is_off() const { return board.pulse(kArm) == 0 && board.pulse(kMotor) == 0; }
  bool moves() const { return board.pulse(kMotor) == 14'000; }

  Rig rig;
  kernel::Kernel& kernel = rig.kernel;
  test::NotingBoard& board = rig.board;
  Runtime& runtime = rig.runtime;
  kernel::Thread link;
  std::vector<std::byte> next;
  bool is_running = false;
  unsigned places = 1U << 31U;  // calls of the board or the trace in this upload
  unsigned last = 0;            // of the last upload
  unsigned act_at = 0;
  std::function<void()> act;
};

// Uploads `program` again and again into a robot that `prepare` has made ready, calls `act` at another place each
// time, and then `check`.
template <class Prepare, class Act, class Check>
void at_each_place(const std::vector<std::byte>& program, Prepare prepare, Act act, Check check) {
  unsigned last = 1;
  for (unsigned place = 1; place <= last; ++place) {
    CAPTURE(place);
    Changing robot;
    prepare(robot);
    robot.act_at = place;
    robot.act = [&] { act(robot.runtime); };
    robot.upload(program);
    last = robot.last;
    if (last < place) break;  // the place was not reached
    robot.go_on(500);
    check(robot);
  }
  CHECK(last > 3);
}

}  // namespace

TEST_CASE("a stop holds at whatever moment of an upload it comes") {
  const std::vector<std::byte> program = test::compile(kChangingProgram, outputs_with("coast"));
  const bool after_another = GENERATE(false, true);
  CAPTURE(after_another);
  const auto prepare = [&](Changing& robot) {
    if (!after_another) return;
    robot.upload(program);
    robot.go_on(2000);
    REQUIRE((robot.moves() && robot.board.pulse(kArm) != 0));
  };
  at_each_place(
      program, prepare, [](Runtime& runtime) { runtime.stop(); },
      [](Changing& robot) {
        CHECK(robot.runtime.stopped());
        CHECK(robot.is_off());
        robot.runtime.resume();
        robot.go_on(500);
        CHECK(robot.moves());
      });
}

TEST_CASE("a stop reaches the pins of the program that goes, at once") {
  const std::vector<std::byte> program = test::compile(kChangingProgram, outputs_with("coast"));
  Changing robot;
  robot.upload(program);
  robot.go_on(2000);
  std::vector<std::uint32_t> seen;  // on the motor, at every access to a pin
  robot.board.on_pin = nullptr;
  robot.act_at = 1;  // the only event before the next program is there: its activation
  robot.act = [&] {
    robot.runtime.stop();
    robot.rig.on_event = nullptr;
    robot.board.on_pin = [&] { seen.push_back(robot.board.pulse(kMotor)); };
  };
  robot.upload(program);
  REQUIRE_FALSE(seen.empty());
  CHECK(seen.back() == 0);  // long before the next program uses its pins
  CHECK(robot.is_off());
}

TEST_CASE("a resume holds at whatever moment of an upload it comes") {
  const std::vector<std::byte> program = test::compile(kChangingProgram, outputs_with("coast"));
  const auto prepare = [&](Changing& robot) {
    robot.upload(program);
    robot.go_on(1000);
    robot.runtime.stop();
    robot.go_on(10);
  };
  at_each_place(
      program, prepare, [](Runtime& runtime) { runtime.resume(); },
      [](Changing& robot) {
        CHECK_FALSE(robot.runtime.stopped());
        CHECK(robot.moves());
      });
}

TEST_CASE("a program that comes while all is stopped has its own safe state") {
  Changing robot;
  robot.upload(test::compile(kChangingProgram, outputs_with("hold")));
  robot.go_on(2000);
  robot.runtime.stop();
  robot.go_on(10);
  REQUIRE(robot.board.pulse(kArm) != 0);  // it holds
  REQUIRE(robot.board.pulse(kMotor) == 0);
  robot.upload(test::compile(kChangingProgram, outputs_with("coast")));
  robot.go_on(10);
  CHECK(robot.is_off());
}

TEST_CASE("measurements end before the image that says where they are is overwritten") {
  const std::string sonar =
      R"({"name": "sonar", "type": "GPIO", "trigger": 7, "echo": 41, "device": "hc-sr04"}, )";
  Changing robot;
  robot.upload(test::compile("WHEN sonar DISTANCE < 20cm\nDO RUN motor TO 70%\nEND\n",
                             outputs_with("coast", sonar)));
  robot.go_on(130);
  const unsigned before = robot.board.takes;
  bool is_whole = true;
  robot.board.echo_us = [&](std::uint16_t echo) {
    is_whole = is_whole && echo == kSonarEcho;
    return 0;
  };
  robot.upload(
      test::compile("WHEN near X < 20\nDO RUN motor TO 70%\nEND\n", outputs_with("coast")));
  CHECK(robot.board.takes > before);
  CHECK(is_whole);
}

namespace {

constexpr std::uint16_t kBumper = 40;
constexpr unsigned kSampleMs = 20;                      // of a button
constexpr unsigned kWaitMs = compiler::kSafetyStartMs;  // for the readings of SAFETY rules
const char* const kGuardedProgram =
    "SAFETY crash\n  WHEN bumper IS PRESSED\n  DO STOP motor\n  RESUME WHEN NOT bumper IS "
    "PRESSED\nEND\n"
    "EVERY 10ms\nDO\n  RUN motor TO 70%\nEND\n";

// A robot with a motor that runs into something, and stops at it.
struct Guarded : Changing {
  Guarded() {
    board.level = [this](std::uint16_t pin) { return pin != kBumper || !is_pressed; };
    upload(program);
    go_on(500);
    REQUIRE(moves());
  }
  // How many ms from now the motor is off for good: while a program waits for its first readings, it is off in between.
  unsigned until_off() {
    unsigned went_on = 0;
    for (unsigned ms = 1; ms <= 4 * kWaitMs; ++ms) {
      go_on(1);
      if (board.pulse(kMotor) != 0) went_on = ms;
    }
    return went_on;
  }
  const std::vector<std::byte> program = test::compile(
      kGuardedProgram,
      outputs_with("coast",
                   R"({"name": "bumper", "type": "GPIO", "pin": 40, "device": "button"}, )"));
  bool is_pressed = false;
};

}  // namespace

TEST_CASE("a hazard at whatever moment of an upload stops the motor as soon as without an upload") {
  for (unsigned place = 1, last = 1; place <= last; ++place) {
    CAPTURE(place);
    Guarded robot;
    robot.act_at = place;
    robot.act = [&] { robot.is_pressed = true; };
    robot.upload(robot.program);
    last = robot.last;
    robot.is_pressed = true;
    CHECK(robot.until_off() <= kSampleMs + 1);
  }
  for (unsigned after = 0; after < 2 * kWaitMs; ++after) {
    CAPTURE(after);
    Guarded robot;
    robot.upload(robot.program);
    robot.go_on(after);
    robot.is_pressed = true;
    CHECK(robot.until_off() <= kSampleMs + 1);
  }
  for (unsigned before = 0; before <= kSampleMs; ++before) {
    CAPTURE(before);
    Guarded robot;
    robot.is_pressed = true;
    robot.go_on(before);
    robot.upload(robot.program);
    CHECK(robot.until_off() + before <= kSampleMs + 1);
  }
}

TEST_CASE("a hazard that is there before an upload, during it and after it holds the motor") {
  Guarded robot;
  robot.is_pressed = true;
  (void)robot.until_off();
  std::vector<std::uint32_t> seen;
  robot.board.on_pin = [&] { seen.push_back(robot.board.pulse(kMotor)); };
  robot.upload(robot.program);
  CHECK(robot.until_off() == 0);
  CHECK(std::ranges::all_of(seen, [](std::uint32_t pulse) { return pulse == 0; }));
  robot.is_pressed = false;
  robot.go_on(2 * kSampleMs + 20);
  CHECK(robot.moves());
}
