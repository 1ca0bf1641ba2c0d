// Which SAFETY rules end a trial: those that trip in it and had not tripped in the program before.
#include <catch2/catch.hpp>

#include "runtime-m4/safety/rule_key.hpp"
#include "tests/runtime-m4/update/kept.hpp"

using namespace robosync;
using test::keep;
using test::kStoreBytes;
using test::kTrialMs;
using test::MemoryStore;
using test::name_of;
using test::Robot;
using test::run_on;
using test::started;

namespace {

// Nothing feeds touch LEVEL, so a rule that reads it trips at the start.
std::string limit_rule(int limit) {
  return "SAFETY guard\n  WHEN touch LEVEL > " + std::to_string(limit) +
         "\n  DO STOP left_arm\nEND\n";
}
const std::string kOther = "SAFETY other\n  WHEN touch LEVEL < 1\n  DO STOP left_arm\nEND\n";
const std::string kOtherArm = "SAFETY other\n  WHEN touch LEVEL > 4\n  DO STOP right_arm\nEND\n";
// Trips only in programs that set `heat`.
const std::string kHeat =
    "REMEMBER heat = 0\nSAFETY hot\n  WHEN heat > 4\n  DO STOP left_arm\nEND\n";
const std::string kSetsHeat = "AT START DO SET heat TO 5 END\n";

tool::Program with(const std::string& rules) {
  return test::compile(rules + test::program_text(3));
}

// The program that runs after the trial of `program`.
link::ProgramHash after_trial(MemoryStore& memory, const tool::Program& program) {
  Robot robot(boards::kMemory, &memory);
  robot.run(1000);
  run_on(robot, program);
  robot.run(kTrialMs + 2000);
  return tool::Client(robot).hello().program_hash;
}

// Does `next` pass its trial on a robot that keeps `before`?
bool passes(const tool::Program& before, const tool::Program& next) {
  MemoryStore memory(kStoreBytes);
  keep(memory, before);
  const bool passed = after_trial(memory, next) == name_of(next);
  CHECK(started(memory) == name_of(passed ? next : before));
  return passed;
}

std::uint32_t key_of(const tool::Program& program) {
  return safety::rule_key(program.image(), program.image().rules[0]);
}

}  // namespace

TEST_CASE("a SAFETY rule that trips in the trial brings the kept program back") {
  CHECK_FALSE(passes(test::program(3), with(limit_rule(4))));
}

TEST_CASE("a SAFETY rule that had tripped in the program before, too, does not end the trial") {
  CHECK(passes(with(limit_rule(4)), with(limit_rule(5))));
  CHECK(passes(with(limit_rule(4)), with(limit_rule(4) + kHeat)));
}

TEST_CASE("another SAFETY rule that trips ends the trial, whatever had tripped before") {
  CHECK_FALSE(passes(with(limit_rule(4)), with(limit_rule(4) + kOther)));
  CHECK_FALSE(passes(with(limit_rule(4)), with(kOtherArm)));
  CHECK_FALSE(passes(with(limit_rule(4) + kHeat), with(limit_rule(4) + kHeat + kSetsHeat)));
}

TEST_CASE(
    "in a trial that is interrupted by another upload, the kept program's trips still count") {
  MemoryStore memory(kStoreBytes);
  const tool::Program kept = with(kHeat + kSetsHeat), next = with(kHeat);
  const tool::Program trips_again = test::compile(kHeat + kSetsHeat + test::program_text(5));
  keep(memory, kept);
  Robot robot(boards::kMemory, &memory);
  robot.run(1000);
  run_on(robot, next);
  robot.run(1000);
  run_on(robot, trips_again);
  robot.run(kTrialMs + 2000);
  CHECK(tool::Client(robot).hello().program_hash == name_of(trips_again));
}

TEST_CASE("a SAFETY rule is found again by what it reads, asks and halts, not by its numbers") {
  const std::uint32_t key = key_of(with(limit_rule(4)));
  CHECK(key == key_of(with(limit_rule(5))));
  CHECK(key == key_of(with(limit_rule(4) + kHeat)));
  CHECK(key != key_of(with(kOther)));
  CHECK(key != key_of(with(kOtherArm)));
  CHECK(key != key_of(with(kHeat)));
}
