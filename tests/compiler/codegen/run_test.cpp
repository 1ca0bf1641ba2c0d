// What generated code does when it runs.
#include "tests/compiler/codegen/run.hpp"

#include <algorithm>
#include <map>

#include <catch2/catch.hpp>

#include "tests/compiler/codegen/moves.hpp"

using namespace robosync;
using namespace robosync::compiler;
using namespace robosync::compiler::testing;

namespace {

ir::Statement turn_to(E value) {
  return line(24, move(0, {{vm::Param::to, std::move(value)}}));
}

constexpr unsigned kPauses = 50;

// What an AT START response does in the world.
Effects effects(ir::Block block, World world, std::vector<ir::Variable> variables = {},
                const std::function<void(World&)>& pass_time = {}) {
  for (const ir::Variable& one : variables)
    world.variables.push_back(one.initial);
  const Built built = must_build(program_of({at_start(std::move(block))}, std::move(variables)));
  return Runner(built.image, 0).respond(0, world, kPauses, pass_time);
}

World with_level(vm::Value level) {
  World world;
  world.channels[0] = level;
  return world;
}

std::size_t count(const Effects& effects, const std::string& what) {
  return static_cast<std::size_t>(std::count(effects.begin(), effects.end(), what));
}

}  // namespace

TEST_CASE("IF chooses a side only when it knows") {
  const ir::Block block = {line(10, ir::If{greater(channel(0), number(3)), {kLeft}, {kRight}}),
                           kSound};
  CHECK(effects(block, with_level(4000)) == Effects{"left", "sound"});
  CHECK(effects(block, with_level(3000)) == Effects{"right", "sound"});
  CHECK(effects(block, with_level(vm::kUnknown)) == Effects{"sound"});
  const ir::Block alone = {line(10, ir::If{greater(channel(0), number(3)), {kLeft}, {}})};
  CHECK(effects(alone, with_level(4000)) == Effects{"left"});
  CHECK(effects(alone, with_level(vm::kUnknown)).empty());
}

TEST_CASE("REPEAT runs as often as it is told") {
  const ir::Block block = {line(10, ir::Repeat{ir::RepeatKind::times, channel(0), {kLeft, kWait}})};
  const std::map<vm::Value, std::size_t> expected = {
      {3000, 3}, {1000, 1}, {2500, 3}, {1, 1}, {0, 0}, {-2000, 0}, {vm::kUnknown, 0}};
  for (const auto& [level, times] : expected) {
    INFO(level);
    CHECK(effects(block, with_level(level)).size() == times);
    if (level == vm::kUnknown) continue;
    ir::Repeat constant{ir::RepeatKind::times, number(0), {kLeft}};
    constant.control.constant = level;
    CHECK(effects({line(10, constant)}, {}).size() == times);
  }
}

TEST_CASE("REPEATs nest, and each keeps its own count") {
  const ir::Statement inner =
      line(11, ir::Repeat{ir::RepeatKind::times, channel(0), {kLeft, kWait}});
  const ir::Block block = {line(10, ir::Repeat{ir::RepeatKind::times, number(3), {inner, kRight}})};
  const Effects done = effects(block, with_level(2000));
  CHECK(done.size() == 9);
  CHECK(count(done, "left") == 6);
}

TEST_CASE("REPEAT WHILE ends when its condition does") {
  const ir::Block block = {
      line(10, ir::Repeat{ir::RepeatKind::while_,
                          less(variable(0), number(3)),
                          {kLeft, line(11, ir::Set{0, number(1), true}), kWait}}),
      kSound};
  CHECK(effects(block, {}, {plain("n")}) == Effects{"left", "left", "left", "sound"});
  CHECK(effects(block, {}, {plain("n", 3)}) == Effects{"sound"});
}

TEST_CASE("PICK ONE takes each option as often as its share says") {
  const ir::Pick pick{{{60000, {kLeft}}, {30000, {kRight}}, {10000, {kSound}}}};
  const Built built = must_build(program_of({at_start({line(10, pick)})}));
  Runner runner(built.image, 0);
  runner.machine.random = 0x0506'0708;
  std::map<std::string, int> taken;
  constexpr int kRuns = 10000;
  for (int i = 0; i < kRuns; ++i) {
    World world;
    const Effects done = runner.respond(0, world, 0);
    REQUIRE(done.size() == 1);
    ++taken[done[0]];
  }
  CHECK(taken["left"] == Approx(6000).margin(250));
  CHECK(taken["right"] == Approx(3000).margin(250));
  CHECK(taken["sound"] == Approx(1000).margin(150));
}

TEST_CASE("a response sees what it has set, clamped") {
  const ir::Statement raise = line(10, ir::Set{0, number(60), true});
  const ir::Statement lower = line(11, ir::Set{0, channel(0), true});
  const std::vector<ir::Variable> joy = {ranged("joy", 0, 100)};
  CHECK(effects({raise, raise, turn_to(variable(0))}, {}, joy) == Effects{"left 0:100000"});
  CHECK(effects({raise, lower, turn_to(variable(0))}, with_level(-90000), joy) ==
        Effects{"left 0:0"});
  CHECK(effects({line(10, ir::Set{0, number(150), false}), turn_to(variable(0))}, {}, joy) ==
        Effects{"left 0:100000"});
  CHECK(effects({line(10, ir::Set{0, channel(0), false}), turn_to(variable(0))}, with_level(-5000),
                joy) == Effects{"left 0:0"});
}

TEST_CASE("SET assigns, RAISE only shifts, and unknown does neither") {
  const auto built = must_build(program_of(
      {at_start({line(10, ir::Set{0, number(5), false}), line(11, ir::Set{1, number(1), true}),
                 line(12, ir::Set{2, channel(0), false})})},
      {plain("a"), plain("b"), plain("c", 7)}));
  Runner runner(built.image, 0);
  World world = with_level(vm::kUnknown);
  world.variables = {0, 2000, 7000};
  (void)runner.respond(0, world, 0);
  CHECK(runner.machine.assigned == 1);
  CHECK(runner.machine.written() == 3);
  CHECK(world.variables == std::vector<vm::Value>{5000, 3000, 7000});
}

TEST_CASE("WAIT UNTIL goes on when its condition is true, or when its time is over; after 20 ms") {
  const ir::WaitUntil wait{greater(channel(0), number(3)), number(0.03)};
  const ir::Block block = {line(10, wait), turn_to(channel(1))};
  const auto clock = [](World& world) {
    world.channels[1] = static_cast<vm::Value>(world.now);
    if (world.now == 25) world.channels[0] = 4000;
  };
  CHECK(effects(block, with_level(0), {}, clock) == Effects{"left 0:25"});
  const auto never = [](World& world) {
    world.channels[1] = static_cast<vm::Value>(world.now);
    world.channels[0] = vm::kUnknown;
  };
  CHECK(effects(block, with_level(0), {}, never) == Effects{"left 0:30"});
  CHECK(effects(block, with_level(4000), {}, clock) == Effects{"left 0:20"});
}

TEST_CASE("what a DEFINE is given outlasts waits, whatever the sensors do") {
  const ir::Block block = {line(10, ir::Local{7, of(Operation::multiply, {channel(0), number(2)})}),
                           kWait, line(11, ir::Then{}), turn_to(local(7))};
  const auto later = [](World& world) { world.channels[0] = 1; };
  CHECK(effects(block, with_level(21000), {}, later) == Effects{"left 0:42000"});
}

TEST_CASE("a watched time word is seen inside the response") {
  const E long_enough = held(greater(channel(0), number(3)), 0.02);
  const ir::Block block = {line(10, ir::If{long_enough, {kLeft}, {kRight}}),
                           line(11, ir::WaitUntil{long_enough, {}}), turn_to(channel(1))};
  const auto clock = [](World& world) { world.channels[1] = static_cast<vm::Value>(world.now); };
  CHECK(effects(block, with_level(4000), {}, clock) == Effects{"right", "left 0:20"});
}

TEST_CASE("a rule outside reads a limit beyond the 256th constant") {
  std::vector<ir::Rule> rules;
  for (int i = 0; i < 250; ++i)
    rules.push_back(when(less(channel(1), number(1000 + i)), {kSound}));
  for (int i = 0; i < 5; ++i)
    rules.push_back(when(less(channel(1), number(2000 + i)), {kSound}));
  ir::Program program = program_of(rules, {ranged("joy", 0, 100)});
  const std::vector<std::pair<Operation, vm::Value>> comparisons = {
      {Operation::less, vm::kFalse},    {Operation::less_equal, vm::kTrue},
      {Operation::greater, vm::kFalse}, {Operation::greater_equal, vm::kTrue},
      {Operation::equal, vm::kTrue},    {Operation::not_equal, vm::kFalse}};
  std::vector<ir::Rule> last;
  for (const auto& [operation, truth] : comparisons)
    last.push_back(when(of(operation, {channel(0), number(7777)}),
                        {line(10, ir::Set{0, channel(0), true}), turn_to(variable(0))}));
  program.behaviors.push_back({40, "late", last});
  const Built built = must_build(program);
  REQUIRE(built.image.constants.size() > 256);
  Runner runner(built.image, 1);
  World world = with_level(7777000);
  world.variables = {0};
  for (std::size_t i = 0; i < comparisons.size(); ++i) {
    INFO(i);
    CHECK(runner.condition(i, world) == comparisons[i].second);
    CHECK(runner.respond(i, world, 0) == Effects{"left 0:100000"});
  }
}
