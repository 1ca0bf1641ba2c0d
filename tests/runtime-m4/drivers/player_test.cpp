// A sound player: its commands, their times, and silence whenever it may not sound. tests/e2e/test_sound.py checks the line.
#include "runtime-m4/policy/player.hpp"

#include <memory>

#include <catch2/catch.hpp>

#include "runtime-m4/guard/output_guard.hpp"
#include "tests/runtime-m4/rig.hpp"
#include "tests/runtime-m4/robot.hpp"
#include "tests/vm/image_builder.hpp"

using namespace robosync;

namespace {

const char* const kPlayerRobot = R"({
  "sensors": [{"name": "near", "type": "VIRTUAL", "channels": {"X": {"range": [0, 100]}}}],
  "actuators": [{"name": "sound", "type": "UART", "device": "dfplayer",
                 "sounds": ["one.wav", "two.wav", {"file": "three.wav", "duration": "300ms"}]},
                {"name": "arm", "type": "PWM", "pin": 0, "device": "servo"}]})";
constexpr unsigned kGap = policy::kPlayerGapMs;
constexpr unsigned kLook = 10;  // ms from one check of the safety monitor to the next

std::vector<unsigned> bytes_of(const policy::PlayerCommand& command) {
  std::vector<unsigned> bytes;
  for (const std::byte byte : command)
    bytes.push_back(std::to_integer<unsigned>(byte));
  return bytes;
}

// The sounds sent on the board's line; the player must know each command.
std::vector<unsigned> sounds_of(const test::NotingBoard& board) {
  std::vector<unsigned> sounds;
  for (const auto& [line, command] : board.said) {
    CHECK(line == 1);
    const auto low = std::to_integer<std::uint16_t>(command[6]);
    CHECK(bytes_of(command) == bytes_of(policy::player_command(low)));
    sounds.push_back(low);
  }
  return sounds;
}

struct Speaking {
  explicit Speaking(const std::string& body) {
    const std::string rsl = test::stops_when_far(body);
    REQUIRE(rig.activate(test::compile(rsl, kPlayerRobot)).ok());
    rig.feed(0, 6);
    rig.run(at);
    rig.feed(0, 20);
  }
  // All of them, after `milliseconds` more.
  std::vector<unsigned> told_after(unsigned milliseconds) {
    rig.run(at += milliseconds);
    return sounds_of(rig.board);
  }

  test::Rig rig;
  unsigned at = 200;
};

using Told = std::vector<unsigned>;

}  // namespace

TEST_CASE("player: its commands are those of the manual") {
  CHECK(bytes_of(policy::player_command(1)) ==
        Told{0x7E, 0xFF, 6, 0x12, 0, 0, 1, 0xFE, 0xE8, 0xEF});
  CHECK(bytes_of(policy::player_command(0x123)) ==
        Told{0x7E, 0xFF, 6, 0x12, 0, 1, 0x23, 0xFE, 0xC5, 0xEF});
  CHECK(bytes_of(policy::player_command(0)) ==
        Told{0x7E, 0xFF, 6, 0x16, 0, 0, 0, 0xFE, 0xE5, 0xEF});
}

TEST_CASE("player: it begins in silence, plays a sound for its length, and is silent then") {
  Speaking robot("PLAY sound \"three.wav\"");
  CHECK(sounds_of(robot.rig.board) == Told{0});
  CHECK(robot.told_after(kLook) == Told{0, 3});
  CHECK(robot.told_after(300 - kLook - 1) == Told{0, 3});
  CHECK(robot.told_after(1 + kLook) == Told{0, 3, 0});
  Speaking cut("PLAY sound \"three.wav\" FOR 100ms");
  CHECK(cut.told_after(100 + kLook) == Told{0, 3, 0});
  Speaking usual("PLAY sound \"one.wav\"");
  CHECK(usual.told_after(999) == Told{0, 1});
  CHECK(usual.told_after(1 + kLook) == Told{0, 1, 0});
}

TEST_CASE("player: one sound behind the other needs no silence in between; STOP is silence") {
  Speaking robot("PLAY sound \"one.wav\" FOR 100ms\nPLAY sound \"two.wav\" FOR 100ms");
  CHECK(robot.told_after(200 + kLook) == Told{0, 1, 2, 0});
  Speaking stops("PLAY sound \"one.wav\" FOR 60s\nWAIT 100ms\nSTOP sound");
  CHECK(stops.told_after(100 + kLook) == Told{0, 1, 0});
}

TEST_CASE("player: it has its time between two commands, and only the last order counts") {
  Speaking robot(
      "PLAY sound \"one.wav\" FOR 20ms\nPLAY sound \"two.wav\" FOR 15ms\nPLAY sound \"three.wav\" "
      "FOR 60s");
  CHECK(robot.told_after(kLook) == Told{0, 1});
  CHECK(robot.told_after(kGap - kLook) == Told{0, 1});
  CHECK(robot.told_after(2 * kLook) == Told{0, 1, 3});
}

TEST_CASE("player: a halt is silence, and so is all until it is over") {
  for (const bool person : {false, true}) {
    Speaking robot("PLAY sound \"one.wav\" FOR 60s");
    CHECK(robot.told_after(100) == Told{0, 1});
    if (person)
      robot.rig.runtime.stop();
    else
      robot.rig.feed(0, 95);
    CHECK(robot.told_after(kLook) == Told{0, 1, 0});
    CHECK(robot.told_after(3000) == Told{0, 1, 0});
    if (person) robot.rig.runtime.resume();
    robot.rig.feed(0, 0);
    CHECK(robot.told_after(1000) == Told{0, 1, 0});
    robot.rig.feed(0, 20);
    CHECK(robot.told_after(kLook) == Told{0, 1, 0, 1});
  }
}

TEST_CASE(
    "player: a program without it ends what it plays, and so does none; one that has it begins in "
    "silence") {
  Speaking robot("PLAY sound \"one.wav\" FOR 60s");
  CHECK(robot.told_after(100) == Told{0, 1});
  const auto other = test::compile("WHEN near X > 10\nDO\nMOVE arm TO 10deg\nEND\n", kPlayerRobot);
  REQUIRE(robot.rig.activate(other).ok());
  CHECK(sounds_of(robot.rig.board) == Told{0, 1, 0});
  Speaking cleared("PLAY sound \"one.wav\" FOR 60s");
  CHECK(cleared.told_after(100) == Told{0, 1});
  cleared.rig.runtime.clear();
  CHECK(sounds_of(cleared.rig.board) == Told{0, 1, 0});
  Speaking again("PLAY sound \"one.wav\" FOR 60s");
  CHECK(again.told_after(100) == Told{0, 1});
  REQUIRE(
      again.rig.activate(test::compile("AT START\nDO\nPLAY sound \"two.wav\"\nEND\n", kPlayerRobot))
          .ok());
  CHECK(sounds_of(again.rig.board) == Told{0, 1});  // the second may replace the first
  again.rig.run(again.at + kGap + 2 * kLook);
  CHECK(sounds_of(again.rig.board) == Told{0, 1, 2});
}

// A player may miss a command that comes too soon, and would play its file to the end.
TEST_CASE("player: silence has its time, too, when the program ends right after it began a sound") {
  const std::string arm = "WHEN near X > 10\nDO\nMOVE arm TO 10deg\nEND\n";
  const auto activate = [](Speaking& robot, const std::string& rsl) {
    REQUIRE(robot.rig.activate(test::compile(rsl, kPlayerRobot)).ok());
  };
  const auto begun = [] {
    auto robot = std::make_unique<Speaking>("PLAY sound \"one.wav\" FOR 60s");
    CHECK(robot->told_after(2 * kLook) == Told{0, 1});
    return robot;
  };
  const auto other = begun();
  activate(*other, arm);
  CHECK(other->told_after(kLook) == Told{0, 1});
  other->rig.feed(0, 0);
  other->rig.feed(0, 20);  // the arm moves: it does not own what must still be told
  CHECK(other->told_after(kGap) == Told{0, 1, 0});
  CHECK(other->told_after(1000) == Told{0, 1, 0});
  CHECK(other->rig.board.pulse(0) != 0);
  const auto none = begun();
  none->rig.runtime.clear();
  CHECK(none->told_after(kLook) == Told{0, 1});
  CHECK(none->told_after(kGap + 60) == Told{0, 1, 0});  // without a program checks are rarer
  const auto twice = begun();
  twice->rig.runtime.clear();
  activate(*twice, arm);
  activate(*twice, arm);
  CHECK(twice->told_after(kLook) == Told{0, 1});
  CHECK(twice->told_after(kGap) == Told{0, 1, 0});
  const auto again = begun();
  again->rig.runtime.clear();
  activate(*again, "AT START\nDO\nPLAY sound \"two.wav\" FOR 60s\nEND\n");
  CHECK(again->told_after(1000) == Told{0, 1, 2});
}

TEST_CASE("player: the guard tells nothing for whom it has halted, nor for who has no line") {
  kernel::Kernel kernel;
  test::NotingBoard board;
  guard::OutputGuard outputs(kernel, board);
  auto wiring = test::servo_and(vm::DriverId::player, vm::Release::coast);
  wiring[1].bus = 1;
  vm::Image image;
  image.actuators = wiring;
  kernel::Time now = 0;
  const auto tell = [&] {
    outputs.go_on(now += kernel::milliseconds(2 * kGap));
    return sounds_of(board);
  };
  outputs.play(1, 7);  // no program owns it yet
  CHECK(tell().empty());
  outputs.own(image);
  CHECK(tell() == Told{0});
  outputs.play(0, 7);
  CHECK(tell() == Told{0});
  outputs.play(1, 7);
  CHECK(tell() == Told{0, 7});
  outputs.halt(0b10);
  outputs.play(1, 8);
  CHECK(tell() == Told{0, 7, 0});
  outputs.let_go(0b10);
  CHECK(tell() == Told{0, 7, 0});
  outputs.play(1, 9);
  outputs.halt(0b10);  // before the command was sent
  outputs.let_go(0b10);
  CHECK(tell() == Told{0, 7, 0, 0});
  outputs.disown();
  CHECK(sounds_of(board) == Told{0, 7, 0, 0, 0});
  outputs.play(1, 9);
  CHECK(tell() == Told{0, 7, 0, 0, 0});
  outputs.own(image);
  outputs.play(1, 5);
  CHECK(tell() == Told{0, 7, 0, 0, 0, 5});
  outputs.disown();  // during the sound
  CHECK(sounds_of(board) == Told{0, 7, 0, 0, 0, 5, 0});
}

TEST_CASE(
    "player: two on a line, a line the board lacks, and one that would hold its sound are "
    "refused") {
  const auto judged = [](auto change) {
    std::vector<std::byte> bytes = test::compile(
        "WHEN near X > 10\nDO\nPLAY sound \"one.wav\"\nMOVE arm TO 10deg\nEND\n", kPlayerRobot);
    vm::Image image;
    REQUIRE(vm::view_image(bytes, image));
    for (const vm::Actuator& actuator : image.actuators)
      change(const_cast<vm::Actuator&>(actuator));
    vm::test::repair_crc(bytes);
    return test::Rig().activate(bytes).refusal;
  };
  CHECK(judged([](vm::Actuator&) {}) == vm::Refusal::none);
  CHECK(judged([](vm::Actuator& actuator) {
          actuator.driver = vm::DriverId::player;
          actuator.bus = 1;
          actuator.safe = vm::Release::coast;
        }) == vm::Refusal::shared_pin);
  for (const std::uint8_t line : {std::uint8_t{0}, std::uint8_t{2}})
    CHECK(judged([line](vm::Actuator& actuator) {
            if (actuator.driver == vm::DriverId::player) actuator.bus = line;
          }) == vm::Refusal::no_bus);
  CHECK(judged([](vm::Actuator& actuator) {
          if (actuator.driver == vm::DriverId::player) actuator.safe = vm::Release::hold;
        }) == vm::Refusal::drives_on);
}
