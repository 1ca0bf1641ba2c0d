// MOTION and PERFORM: the servos' positions over time, according to a table.
#include <catch2/catch.hpp>

#include "tests/runtime-m4/rig.hpp"
#include "tests/runtime-m4/robot.hpp"

using robosync::test::compile;
using robosync::test::Rig;
using robosync::test::Robot;

namespace {

// Two servos, whose pulses of 500 to 2500 us are 0 to 180 deg.
const char* const kPuppet = R"({
  "sensors": [{"name": "near", "type": "VIRTUAL", "channels": {"X": {"range": [0, 100]}}}],
  "actuators": [
    {"name": "arm", "type": "PWM", "pin": 3, "device": "servo", "range": ["0deg", "180deg"],
     "on_release": "hold"},
    {"name": "head", "type": "PWM", "pin": 4, "device": "servo", "range": ["0deg", "180deg"]}]})";

const char* const kWave = R"(
MOTION wave OF arm, head
  AT 100ms 90deg 0deg
  AT 300ms 30deg -
  AT 500ms 90deg 60deg
END
)";

int degrees(const Rig& rig, std::uint16_t pin) {
  return static_cast<int>(((rig.board.pwm_read(pin) - 500) * 180 + 1000) / 2000);
}

class Puppet {
public:
  explicit Puppet(const std::string& response, const std::string& rest = "") {
    const std::string rule = "WHEN near X > 10\nDO " + response + "\nEND\n";
    REQUIRE(rig_.activate(compile(kWave + rest + rule, kPuppet)).ok());
    rig_.feed(0, 20);
  }
  // "arm head" in degrees.
  std::string at(std::uint64_t ms) {
    rig_.run(ms);
    return std::to_string(degrees(rig_, 3)) + " " + std::to_string(degrees(rig_, 4));
  }
  Rig& rig() { return rig_; }

private:
  Rig rig_;
};

}  // namespace

TEST_CASE("PERFORM brings each actuator to each key at its time, evenly in between") {
  Puppet puppet("PERFORM wave");
  CHECK(puppet.at(100) == "90 0");
  CHECK(puppet.at(200) == "60 15");
  CHECK(puppet.at(300) == "30 30");
  CHECK(puppet.at(400) == "60 45");
  CHECK(puppet.at(500) == "90 60");
  CHECK(puppet.rig().only("command done finished") ==
        "0 #1 command arm PERFORM wave\n0 #1 command head PERFORM wave\n"
        "500 #1 done arm\n500 #1 done head\n500 #1 finished r0\n");
}

TEST_CASE("TIMES goes through it again without drift, AT at another speed") {
  Puppet twice("PERFORM wave 2 TIMES");
  CHECK(twice.at(600) == "90 0");
  CHECK(twice.at(800) == "30 30");
  CHECK(twice.at(1000) == "90 60");
  CHECK(twice.rig().only("done") == "1000 #1 done arm\n1000 #1 done head\n");
  Puppet fast("PERFORM wave AT 200%");
  CHECK(fast.at(150) == "30 30");
  CHECK(fast.at(250) == "90 60");
  CHECK(fast.rig().only("done") == "250 #1 done arm\n250 #1 done head\n");
  // The speed in percent is the motion's: an actuator's limit in deg/s does not apply to it.
  Puppet slow("PERFORM wave AT 50%", "LIMIT arm SPEED TO 20deg/s\n");
  slow.at(200);
  CHECK(slow.rig().only("command") ==
        "0 #1 command arm PERFORM wave at=50\n0 #1 command head PERFORM wave at=50\n");
}

TEST_CASE("an actuator that a LIMIT makes late is never faster, and catches up where it can") {
  Puppet puppet("PERFORM wave", "LIMIT arm SPEED TO 300deg/s\n");
  CHECK(puppet.at(100) == "30 0");  // at 300 deg/s it is there at 300 ms
  CHECK(puppet.at(300) == "90 30");
  CHECK(puppet.at(500) == "30 60");  // and continues to the next key immediately
  puppet.at(2000);
  CHECK(puppet.rig().only("done") == "500 #1 done head\n700 #1 done arm\n");
}

TEST_CASE("keys come 20 ms apart at least, however fast it is performed") {
  Puppet puppet("PERFORM wave AT 100000%");
  puppet.at(1000);
  CHECK(puppet.rig().only("done") == "40 #1 done head\n60 #1 done arm\n");
  CHECK(puppet.at(1000) == "90 60");
}

TEST_CASE("STOP ends an actuator's part where it is, and its next command begins there") {
  Puppet puppet("PERFORM wave 100 TIMES\n  WAIT 200ms\n  STOP arm\n  MOVE arm TO 0deg AT 90deg/s");
  CHECK(puppet.at(200) == "60 15");
  CHECK(puppet.at(300) == "51 30");
  CHECK(puppet.at(400) == "42 45");
}

TEST_CASE("a MOTION is one claim: who takes one of its actuators ends all of it") {
  Rig rig;
  REQUIRE(rig.activate(compile(std::string(kWave) + R"(
BEHAVIOR high PRIORITY 20
  WHEN near X > 50
  DO MOVE head TO 90deg AT 90deg/s
  END
END
BEHAVIOR low PRIORITY 10
  WHEN near X > 10
  DO PERFORM wave 100 TIMES
  END
END
)",
                               kPuppet))
              .ok());
  rig.feed(0, 20);
  rig.run(200);
  rig.feed(0, 60);
  rig.run(5000);
  CHECK(rig.only("interrupt cancel") ==
        "200 #2 interrupt r1 by b0\n200 #2 cancel head\n200 #2 cancel arm\n");
  CHECK(degrees(rig, 3) == 60);
  CHECK(degrees(rig, 4) == 90);
}

TEST_CASE("SAFETY halts a MOTION like any command") {
  Puppet puppet("PERFORM wave 100 TIMES", "SAFETY pinch\n  WHEN near X > 80\n  DO STOP arm\nEND\n");
  puppet.at(200);
  puppet.rig().feed(0, 90);
  puppet.at(400);
  CHECK(puppet.rig().board.pwm_read(3) == 0);  // `safe` of a servo: it coasts
  puppet.at(5000);
  CHECK(puppet.rig().board.pwm_read(3) == 0);
}

TEST_CASE("lamps and virtual actuators perform too") {
  Robot robot(
      "MOTION fade OF lamp, neck\n  AT 500ms 100% 10deg\n  AT 1s 0% -\nEND\n"
      "WHEN near X > 10\nDO PERFORM fade\n  THEN\n  LIGHT lamp ON\nEND\n",
      R"({"sensors": [{"name": "near", "type": "VIRTUAL", "channels": {"X": {"range": [0, 100]}}}],
          "actuators": [{"name": "lamp", "type": "PWM", "pin": 3, "device": "pwm"},
                        {"name": "neck", "type": "VIRTUAL", "device": "joint"}]})");
  robot.feed(0, "X", 20);
  robot.run(2000);
  CHECK(robot.only("command done") ==
        "0 #1 command lamp PERFORM fade\n0 #1 command neck PERFORM fade\n"
        "1000 #1 done lamp\n1000 #1 done neck\n1000 #2 command lamp LIGHT ON\n1000 #2 done lamp\n");
}
