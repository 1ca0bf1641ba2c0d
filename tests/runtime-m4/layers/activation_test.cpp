// Programs that are activated, ended and refused; and what continues in the meantime.
#include <cstring>

#include <catch2/catch.hpp>

#include "tests/runtime-m4/layers/draw.hpp"
#include "tests/runtime-m4/rig.hpp"
#include "tests/runtime-m4/robot.hpp"
#include "vm/identity.hpp"

using namespace robosync;
using robosync::test::Rig;

namespace {

std::vector<std::byte> threshold_program(int threshold) {
  return test::compile("WHEN near X > " + std::to_string(threshold) + "\nDO MOVE a FOR 1s\nEND\n",
                       test::kPlainRobot);
}

const char* const kServoRobot = R"({
  "sensors": [{"name": "near", "type": "VIRTUAL", "channels": {"X": {"range": [0, 100]}}}],
  "actuators": [{"name": "arm", "type": "PWM", "pin": 3, "device": "servo",
                 "range": ["0deg", "100deg"], "on_release": "RELEASE", "safe": "coast"}]
})";

std::vector<std::byte> servo_program(const std::string& on_release, int target) {
  std::string json = kServoRobot;
  json.replace(json.find("RELEASE"), 7, on_release);
  return test::compile(
      "WHEN near X > 10\nDO MOVE arm TO " + std::to_string(target) + "deg AT 50deg/s\nEND\n", json);
}

}  // namespace

TEST_CASE("without a program there is a safety thread and nothing to feed") {
  Rig rig;
  rig.run(1000);
  CHECK_FALSE(rig.runtime.running());
  CHECK(rig.kernel.threads().size() == 1);
  CHECK(rig.status().safety_checks == 34);  // at 0, 30 … 990 ms
  CHECK(rig.board.watching);
  CHECK(rig.board.kicks == 34);
  CHECK(rig.feed(0, 1) == link::FeedError::no_program);
}

TEST_CASE("a program gets a thread for each part of it, each in its rank") {
  Rig rig;
  REQUIRE(rig.activate(test::compile(
                           test::high_and_low(test::when_far("MOVE a"), test::when_near("MOVE b")),
                           test::kPlainRobot))
              .ok());
  std::string order;
  for (const kernel::Thread* thread : rig.kernel.threads())
    order += std::string(thread->name()) + ":" + std::to_string(thread->priority().now) + " ";
  // Actuators first; Priority(T) = max over the behaviours that need T; then behaviour, processing, sensor.
  CHECK(order == "safety:0 a:20 b:10 high:20 step:20 feeds:20 low:10 ");
}

TEST_CASE("a new program takes the place of the running one, and the safety thread goes on") {
  Rig rig;
  REQUIRE(rig.activate(threshold_program(10)).ok());
  rig.feed(0, 8);
  rig.feed(0, 20, 100);
  rig.run(500);
  const link::Status before = rig.status();
  CHECK(before.activations == 1);
  CHECK(before.steps == 2);
  REQUIRE(rig.activate(threshold_program(5)).ok());
  CHECK(rig.status().steps == 0);
  CHECK(rig.status().safety_checks == before.safety_checks);
  rig.feed(0, 8);
  rig.run(1000);
  const link::Status after = rig.status();
  CHECK(after.activations == 2);
  CHECK(after.safety_checks == before.safety_checks + 51);  // at 0, 10 … 500 ms of its own
  CHECK(after.safety_late_us == 0);
  CHECK(after.uptime_us == 1'000'000);
  CHECK(after.program_us == 500'000);
  CHECK(after.reset_reason == link::ResetReason::watchdog);
  CHECK(rig.only("activated input fire cancel") ==
        "0 #0 activated\n0 #1 input X 8\n100 #2 input X 20\n100 #2 fire r0 DO\n"
        "500 #2 cancel a\n0 #0 activated\n0 #1 input X 8\n0 #1 fire r0 DO\n");
}

TEST_CASE("a feed that waits for its time dies with its program") {
  Rig rig;
  REQUIRE(rig.activate(threshold_program(10)).ok());
  rig.feed(0, 20, 600);
  rig.run(500);
  REQUIRE(rig.activate(threshold_program(10)).ok());
  rig.run(2000);
  CHECK(rig.only("input").empty());
}

TEST_CASE("a refused image leaves the running program alone") {
  Rig rig;
  REQUIRE(rig.activate(threshold_program(10)).ok());
  std::vector<std::byte> damaged = threshold_program(5);
  damaged[80] ^= std::byte{1};
  const vm::Verdict verdict = rig.activate(damaged);
  CHECK(verdict.refusal == vm::Refusal::bad_crc);
  rig.feed(0, 8);
  rig.feed(0, 20, 100);
  rig.run(500);
  CHECK(rig.status().activations == 1);
  CHECK(rig.only("activated fire") == "0 #0 activated\n100 #2 fire r0 DO\n");
}

TEST_CASE("feeds that cannot be are refused") {
  Rig rig;
  REQUIRE(rig.activate(test::compile("WHEN near X > 10 OR touch LEVEL > 1\nDO MOVE a\nEND\n", R"({
    "sensors": [
      {"name": "touch", "type": "I2C", "address": "0x70", "device": "max34451"},
      {"name": "near", "type": "VIRTUAL", "channels": {"X": {"range": [0, 100]}}}],
    "actuators": [{"name": "a", "type": "VIRTUAL", "device": "virtual_actuator"}]})"))
              .ok());
  rig.run(100);
  CHECK(rig.feed(2, 1) == link::FeedError::no_channel);
  CHECK(rig.feed(255, 1) == link::FeedError::no_channel);
  CHECK(rig.feed(0, 1) == link::FeedError::not_virtual);
  CHECK(rig.feed(1, 1, 99) == link::FeedError::in_the_past);
  CHECK(rig.feed(1, 1, 100) == link::FeedError::none);
  rig.run(101);
  for (unsigned i = 0; i < policy::kFeeds; ++i) {
    const link::FeedResult result = rig.runtime.enqueue(
        {.channel = 1, .at_us = (std::uint64_t{1} << 50) + i * 1000, .value = 0});
    CHECK(result.error == link::FeedError::none);
    CHECK(result.free_places == policy::kFeeds - 1 - i);
  }
  CHECK(rig.feed(1, 1) == link::FeedError::queue_full);
  rig.run(100'000);
  CHECK(rig.status().steps == 1);  // those for the end of time did not come early
}

TEST_CASE(
    "of two feeds for one channel and tick the later to come counts, here and in the simulator") {
  Rig rig;
  REQUIRE(rig.activate(threshold_program(10)).ok());
  rig.feed(0, 8);
  rig.run(0);
  for (const int value : {20, 30, 8})
    rig.feed(0, value, 100);  // back to the known value: no news
  rig.feed(0, 20, 200);
  rig.feed(0, 9, 200);
  rig.feed(0, 5, UINT64_MAX / 1000);  // after the end of time
  rig.run(1000);
  CHECK(rig.only("input") == "0 #1 input X 8\n200 #2 input X 9\n");
}

TEST_CASE("a program that needs more memory than the board has is refused, and only then") {
  const auto bytes = threshold_program(10);
  vm::Image image;
  REQUIRE(vm::view_image(bytes, image));
  const std::uint32_t needs = policy::needs_of(image, boards::kMemory).total;
  policy::BoardMemory memory = boards::kMemory;
  memory.arena_bytes = policy::aligned(needs, policy::kStackUnit);
  Rig large(memory);
  CHECK(large.activate(bytes).ok());
  memory.arena_bytes -= policy::kStackUnit;
  Rig small(memory);
  CHECK(small.activate(bytes).refusal == vm::Refusal::no_room);
  CHECK(small.runtime.checked_needs().total == needs);
  CHECK_FALSE(small.runtime.running());
  CHECK(small.kernel.threads().size() == 1);
}

TEST_CASE("a program that is refused for its memory leaves the running one alone") {
  const auto bytes = threshold_program(10);
  const auto larger =
      test::compile("WHEN near X > 10\nDO MOVE a\nMOVE b\nEND\n", test::kPlainRobot);
  vm::Image image;
  REQUIRE(vm::view_image(bytes, image));
  policy::BoardMemory memory = boards::kMemory;
  memory.arena_bytes =
      policy::aligned(policy::needs_of(image, boards::kMemory).total, policy::kStackUnit);
  REQUIRE(vm::view_image(larger, image));
  REQUIRE_FALSE(policy::needs_of(image, memory).fit(memory));
  Rig rig(memory);
  REQUIRE(rig.activate(bytes).ok());
  rig.feed(0, 8);
  CHECK(rig.activate(larger).refusal == vm::Refusal::no_room);
  rig.feed(0, 20, 100);
  rig.run(500);
  CHECK(rig.only("fire") == "100 #2 fire r0 DO\n");
}

// Counts, lengths and offsets, in the header and in records: whatever an image says, its needs are
// computed from its actual contents, and the layout has room for all of it.
TEST_CASE("an image with changed numbers is refused, or runs in the memory it needs") {
  test::Draw draw(11);
  Rig rig;
  unsigned ran = 0;
  const auto near = threshold_program(10);
  const auto servo = servo_program("hold", 100);
  for (unsigned round = 0; round < 3000; ++round) {
    std::vector<std::byte> bytes = round % 2 == 0 ? near : servo;
    const std::size_t end = draw.one_in(2) ? sizeof(vm::ImageHeader) : bytes.size();
    for (unsigned changes = 1 + draw.below(2); changes > 0; --changes)
      bytes[8 + draw.below(static_cast<unsigned>(end - 8))] =
          static_cast<std::byte>(draw.below(256));
    vm::seal(bytes);
    if (!rig.activate(bytes).ok()) continue;
    ++ran;
    CHECK(rig.runtime.needs().total <= boards::kMemory.arena_bytes);
    for (unsigned c = 0; c < rig.runtime.image().channels.size(); ++c)
      (void)rig.feed(static_cast<std::uint8_t>(c), 20);
    rig.run(rig.kernel.now() / 1000 + 20);
  }
  CHECK(ran > 100);
}

TEST_CASE("a program that is cleared is gone, and another may come") {
  Rig rig;
  REQUIRE(rig.activate(threshold_program(10)).ok());
  rig.feed(0, 8);
  rig.run(100);
  const std::uint32_t used = rig.runtime.needs().total;
  rig.runtime.clear();
  CHECK_FALSE(rig.runtime.running());
  CHECK(rig.runtime.needs().total < used);
  CHECK(rig.feed(0, 20) == link::FeedError::no_program);
  rig.run(200);
  REQUIRE(rig.activate(threshold_program(10)).ok());
  rig.feed(0, 20);
  rig.run(300);
  CHECK(rig.only("fire") == "0 #1 fire r0 DO\n");
}

TEST_CASE("actuators of a program that goes are released as the robot says") {
  const auto pulse_after = [](const std::string& on_release) {
    Rig rig;
    REQUIRE(rig.activate(servo_program(on_release, 100)).ok());
    rig.feed(0, 20);
    rig.run(1000);  // half way
    CHECK(rig.board.pwm_read(3) == 1500);
    REQUIRE(rig.activate(servo_program(on_release, 100)).ok());
    return rig.board.pwm_read(3);
  };
  CHECK(pulse_after("hold") == 1500);
  CHECK(pulse_after("rest") == 500);
  CHECK(pulse_after("coast") == 0);
}

TEST_CASE("what a program does never depends on the one before it") {
  Rig rig;
  std::vector<std::string> alone;
  for (const bool after_another : {false, true}) {
    if (after_another) {
      REQUIRE(rig.activate(servo_program("hold", 70)).ok());
      rig.feed(0, 20);
      rig.run(5000);
    }
    rig.lines.clear();
    REQUIRE(rig.activate(servo_program("hold", 50)).ok());
    rig.feed(0, 20);
    rig.run(rig.kernel.now() / 1000 + 2000);
    if (!after_another) alone = rig.lines;
  }
  CHECK(alone.size() == 7);
  CHECK(rig.lines == alone);
}

TEST_CASE("when the places for commands are all taken one is dropped, and no other is harmed") {
  constexpr int kEach = 7;  // for four actuators: more than there are places, yet no queue is full
  const auto moves = [](const std::string& actuator) {
    std::string commands;
    for (int i = 0; i < kEach; ++i)
      commands += "MOVE " + actuator + " FOR 1s\n";
    return commands;
  };
  test::Robot robot("WHEN near X > 10 DO\n" + moves("a") + moves("b") +
                    "END\nWHEN near X > 20 DO\n" + moves("c") + moves("d") + "END\n");
  robot.feed(10, "X", 30);
  robot.run(60'000);
  const std::uint32_t places =
      policy::needs_of(robot.image(), boards::kMemory).counts[policy::Count::commands];
  REQUIRE(places < 4 * kEach);
  std::size_t commands = 0;
  for (const std::string& line : robot.lines())
    if (line.find(" command ") != std::string::npos) {
      ++commands;
      CHECK_THAT(line, Catch::EndsWith(" MOVE for_=1"));
    }
  CHECK(commands == places);
  CHECK(robot.only("overrun").find("overrun d") != std::string::npos);
}
