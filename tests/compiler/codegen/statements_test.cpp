// What each statement becomes: instructions, frame and records, as golden listings.
#include <catch2/catch.hpp>

#include "tests/compiler/build.hpp"
#include "tests/compiler/codegen/moves.hpp"
#include "tests/support/golden.hpp"

using namespace robosync;
using namespace robosync::compiler;
using namespace robosync::compiler::testing;

namespace {

void expect(const std::string& name, const ir::Program& program) {
  const std::filesystem::path folder = ROBOSYNC_SOURCE_DIR;
  const Built built = must_build(program);
  robosync::testing::expect_golden(folder / "tests/compiler/codegen/golden" / (name + ".txt"),
                                   listing(built.image));
}

void expect_response(const std::string& name, ir::Block block,
                     std::vector<ir::Variable> variables = {}) {
  expect(name, program_of({when(greater(channel(0), number(3)), std::move(block))},
                          std::move(variables)));
}

}  // namespace

TEST_CASE("IF without ELSE is one block", "[golden]") {
  expect_response("if", {line(10, ir::If{less(channel(1), number(20)), {kLeft}, {}}), kSound});
}

TEST_CASE("IF with ELSE leaves both sides out when nothing is known", "[golden]") {
  expect_response("if_else",
                  {line(10, ir::If{less(channel(1), number(20)), {kLeft}, {kRight}}), kSound});
}

TEST_CASE("REPEAT counts down in a local", "[golden]") {
  expect_response("repeat_times",
                  {line(10, ir::Repeat{ir::RepeatKind::times, number(3), {kLeft, kWait}}),
                   line(11, ir::Repeat{ir::RepeatKind::times, channel(1), {kRight, kWait}})});
}

TEST_CASE("REPEAT WHILE looks before and after its body, FOREVER never", "[golden]") {
  const E close = less(channel(1), number(20));
  expect_response("repeat_while",
                  {line(10, ir::Repeat{ir::RepeatKind::while_, close, {kLeft, kWait}}),
                   line(11, ir::Repeat{ir::RepeatKind::forever, {}, {kRight, kWait}})});
}

TEST_CASE("PICK ONE draws once and compares", "[golden]") {
  const ir::Pick two{{{60000, {kLeft}}, {40000, {kRight}}}};
  const ir::Pick three{{{1000, {kLeft}}, {1000, {kRight}}, {2000, {kSound}}}};
  expect_response("pick", {line(10, two), line(11, three)});
}

TEST_CASE("WAIT, WAIT UNTIL and THEN give up the processor", "[golden]") {
  const E close = less(channel(1), number(20));
  expect_response("wait", {kLeft, line(10, ir::Then{}), line(11, ir::Wait{channel(2)}),
                           line(12, ir::WaitUntil{close, {}}),
                           line(13, ir::WaitUntil{close, number(10)}), kRight});
}

TEST_CASE("what is set is clamped at once, what is raised where it is read", "[golden]") {
  const E more = of(Operation::add, {variable(0), number(1)});
  expect_response(
      "set",
      {line(10, ir::Set{0, number(2), false}), line(11, ir::Set{0, more, false}),
       line(12, ir::Set{1, number(150), false}), line(13, ir::Set{1, channel(1), false}),
       line(14, ir::Set{1, number(-15), true}), line(15, ir::Set{0, variable(1), true})},
      {plain("visitors"), ranged("joy", 0, 100)});
}

TEST_CASE("what a DEFINE is given is worked out once", "[golden]") {
  const E angle = of(Operation::random, {number(10), number(20)});
  expect_response("locals", {line(10, ir::Local{0, angle}), line(11, ir::Local{1, number(5)}),
                             line(12, move(0, {{vm::Param::to, local(0)}})), kWait,
                             line(13, move(1, {{vm::Param::to, local(0)},
                                               {vm::Param::over, local(1)},
                                               {vm::Param::at, number(7)}}))});
}

TEST_CASE("a time word inside a response is watched by a rule of its own", "[golden]") {
  const E calm = held(less(channel(1), number(20)), 2);
  const E either = of(Operation::logical_or, {calm, greater(variable(0), number(1))});
  expect_response("watch",
                  {line(10, ir::If{either, {kLeft}, {}}), line(11, ir::WaitUntil{calm, number(10)}),
                   line(12, ir::Set{0, number(1), true}),
                   line(13, ir::Repeat{ir::RepeatKind::while_,
                                       of(Operation::logical_not,
                                          {time_word(Operation::changed, 5, {channel(1)})}),
                                       {kWait}})},
                  {plain("visitors")});
}

TEST_CASE("LOG and ALERT carry their texts", "[golden]") {
  expect_response("texts", {line(10, ir::Log{false, "at {} and {}", {channel(0), number(2)}}),
                            line(11, ir::Log{true, "too close", {}})});
}

TEST_CASE("every time word has a timer, in the order of the code", "[golden]") {
  const E close = less(channel(1), number(20));
  const E dark = less(channel(2), number(5));
  const std::vector<E> conditions = {
      held(close, 1),
      time_word(Operation::counted, 2, {close}, 3),
      time_word(Operation::sequence, 2, {close, dark}),
      time_word(Operation::latch, 0, {close, less(channel(1), number(25))}),
      time_word(Operation::rose, 0, {close}),
      time_word(Operation::changed, 4, {channel(1)}),
      of(Operation::logical_and, {held(held(close, 1), 2), dark})};
  std::vector<ir::Rule> rules;
  for (const E& condition : conditions)
    rules.push_back(when(condition, {kLeft}));
  expect("time_words", program_of(rules));
}

TEST_CASE("rules of every kind", "[golden]") {
  const E close = less(channel(1), number(20));
  ir::Rule sides = when(close, {kLeft});
  sides.kind = vm::RuleKind::when_else;
  sides.else_response = {kRight};
  ir::Rule level = when(close, {kLeft});
  level.kind = vm::RuleKind::while_;
  ir::Rule period = when(of(Operation::random, {number(3), number(7)}), {kSound});
  period.kind = vm::RuleKind::every;
  ir::Rule guard =
      when(close, {line(30, ir::Halt{false, 0, {0, 1}}), line(31, ir::Halt{false, {}, {2}}),
                   line(32, ir::Log{true, "guarded", {}})});
  guard.kind = vm::RuleKind::safety;
  guard.resume = held(greater(channel(1), number(40)), 2);
  ir::Rule all = when(close, {line(33, ir::Halt{true, {}, {}})});
  all.kind = vm::RuleKind::safety;
  ir::Program program = program_of({sides, level, period, at_start({kSound})});
  program.safety = {guard, all};
  expect("rules", program);
}
