// FOLLOW: a servo's pulses while the value that it follows changes.
#include <catch2/catch.hpp>

#include "tests/runtime-m4/rig.hpp"
#include "tests/runtime-m4/robot.hpp"

using robosync::test::compile;
using robosync::test::Rig;

namespace {

const char* const kHead = R"({
  "sensors": [{"name": "near", "type": "VIRTUAL", "channels": {"X": {"range": [0, 100]}}},
              {"name": "voice", "type": "VIRTUAL", "channels": {"D": {"unit": "deg", "range": [-90, 200]}}}],
  "actuators": [
    {"name": "arm", "type": "PWM", "pin": 3, "device": "servo", "range": ["0deg", "180deg"],
     "on_release": "hold"},
    {"name": "head", "type": "PWM", "pin": 4, "device": "servo", "range": ["0deg", "180deg"]}]})";

constexpr unsigned kNear = 0, kVoice = 1;

int degrees_of(const Rig& rig, std::uint16_t pin) {
  return static_cast<int>(((rig.board.pwm_read(pin) - 500) * 180 + 1000) / 2000);
}

// A WHILE that follows from 0 ms on.
class Follower {
public:
  explicit Follower(const std::string& response, const std::string& rest = "") {
    const std::string rule = "WHILE near X > 10\nDO " + response + "\nEND\n";
    REQUIRE(rig_.activate(compile(rest + rule, kHead)).ok());
    rig_.feed(kNear, 20);
  }
  void hear(std::uint64_t ms, int direction) {
    rig_.run(ms);
    rig_.feed(kVoice, direction);
  }
  int arm(std::uint64_t ms) {
    rig_.run(ms);
    return degrees_of(rig_, 3);
  }
  Rig& rig() { return rig_; }

private:
  Rig rig_;
};

}  // namespace

TEST_CASE("an actuator that follows turns round on its way: nothing is queued, done or cancelled") {
  Follower follower("FOLLOW arm TO (voice D) AT 100deg/s");
  follower.hear(10, 90);
  CHECK(follower.arm(510) == 50);
  follower.hear(510, 20);
  CHECK(follower.arm(710) == 30);
  CHECK(follower.arm(1000) == 20);
  CHECK(follower.rig().only("command done cancel finished") ==
        "10 #3 command arm FOLLOW to=90 at=100\n"
        "510 #4 command arm FOLLOW to=20 at=100\n810 #4 done arm\n");
}

TEST_CASE("what changes by less than MARGIN is no new target, and many such changes add up") {
  Follower follower("FOLLOW arm TO (voice D) MARGIN 5deg");
  follower.hear(10, 90);
  for (int i = 1; i <= 5; ++i)
    follower.hear(2000 + 10 * static_cast<unsigned>(i), 90 + i);
  (void)follower.arm(3000);
  CHECK(follower.rig().only("command") ==
        "10 #3 command arm FOLLOW to=90\n2050 #8 command arm FOLLOW to=95\n");
}

TEST_CASE("out of its range it goes to the end of it, and LIMIT holds") {
  Follower follower("FOLLOW arm TO (voice D)", "LIMIT arm SPEED TO 60deg/s\n");
  follower.hear(10, 200);
  CHECK(follower.arm(1010) == 60);
  CHECK(follower.arm(4000) == 180);
  follower.hear(4000, 199);
  CHECK(follower.rig().only("command") == "10 #3 command arm FOLLOW to=180\n");
}

TEST_CASE("several go on together, and end with the WHILE") {
  Follower follower("FOLLOW arm TO (voice D)\n  FOLLOW head TO (180deg - voice D)");
  follower.hear(10, 60);
  CHECK(follower.arm(2000) == 60);
  CHECK(degrees_of(follower.rig(), 4) == 120);
  follower.rig().feed(kNear, 0);
  follower.hear(2100, 90);
  CHECK(follower.arm(3000) == 60);
}

TEST_CASE("FOR ends it; then the response goes on") {
  Follower follower("FOLLOW arm TO (voice D) FOR 1s\n  MOVE arm TO 0deg\n  WAIT 1h");
  follower.hear(10, 45);
  (void)follower.arm(1500);
  CHECK(follower.rig().only("command") ==
        "10 #3 command arm FOLLOW to=45\n1000 #4 command arm MOVE to=0\n");
}

TEST_CASE(
    "it waits until what the response has started before is done, and begins with the newest "
    "value") {
  Follower follower("MOVE arm TO 180deg OVER 1s\n  FOLLOW arm TO (voice D)");
  for (unsigned i = 1; i <= 20; ++i)
    follower.hear(10 * i, static_cast<int>(i));
  (void)follower.arm(1200);
  CHECK(follower.rig().only("command overrun") ==
        "0 #1 command arm MOVE to=180 over=1\n1000 #22 command arm FOLLOW to=20\n");
}

// Each round adds a follow after seven waiting commands, the last of which is a follow.
TEST_CASE("a new target of a follow that waits takes no place from the command behind it") {
  Follower follower(
      "MOVE arm TO 180deg OVER 2s\n  MOVE arm TO 10deg OVER 1s\n  MOVE arm TO 20deg OVER 1s\n"
      "  MOVE arm TO 30deg OVER 1s\n  MOVE arm TO 40deg OVER 1s\n  MOVE arm TO 50deg OVER 1s\n"
      "  MOVE arm TO 60deg OVER 1s\n  REPEAT 2 TIMES\n    FOLLOW arm TO (voice D) FOR 1ms\n    "
      "WAIT 5ms\n  END\n"
      "  FOLLOW arm TO (voice D) FOR 1ms\n  MOVE arm TO 90deg OVER 1s\n  WAIT 1h");
  follower.hear(0, 45);
  (void)follower.arm(9000);
  CHECK(follower.rig().only("overrun").empty());
}

TEST_CASE("a newer value takes the older one's place although all places for commands are taken") {
  std::string moves;
  for (int i = 1; i <= 8; ++i)
    moves += "MOVE arm TO " + std::to_string(10 * i) + "deg OVER 100ms\n";
  Follower follower(moves + "WAIT 10ms\nFOLLOW arm TO (voice D)");
  for (unsigned i = 1; i <= 20; ++i)
    follower.hear(10 + 10 * i, static_cast<int>(i));
  (void)follower.arm(1500);
  CHECK(follower.rig().only("overrun").empty());
  CHECK(follower.rig().only("command").ends_with("command arm FOLLOW to=20\n"));
  CHECK(degrees_of(follower.rig(), 3) == 20);
}

TEST_CASE("an unknown value is no target") {
  Follower follower("FOLLOW arm TO (voice D)");
  (void)follower.arm(500);
  CHECK(follower.rig().only("command").empty());
}
