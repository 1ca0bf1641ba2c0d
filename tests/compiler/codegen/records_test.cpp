// The sections beside the code, and what is refused because it does not fit.
#include <set>

#include <catch2/catch.hpp>

#include "tests/compiler/build.hpp"
#include "tests/compiler/codegen/moves.hpp"
#include "vm/verifier.hpp"

using namespace robosync;
using namespace robosync::compiler;
using namespace robosync::compiler::testing;

namespace {

const E kClose = less(channel(1), number(20));

std::vector<std::string> labels_of(const vm::Image& image, unsigned first, unsigned count) {
  std::vector<std::string> labels;
  for (unsigned i = 0; i < count; ++i)
    labels.emplace_back(image.string(image.labels[first + i]));
  return labels;
}

// Refused as too large, at the line of a statement if one is to blame.
void expect_too_large(const ir::Program& program, const std::string& words,
                      std::uint32_t begin = 0) {
  const Built built = build(program);
  CHECK(built.bytes.empty());
  REQUIRE(built.diagnostics.errors() == 1);
  const Diagnostic& diagnostic = built.diagnostics.all().front();
  INFO(diagnostic.message);
  CHECK(diagnostic.code == Code::E0407);
  CHECK(diagnostic.message.find(words) != std::string::npos);
  CHECK(diagnostic.labels.front().span.begin == begin);
}

ir::Block nested(unsigned depth, const ir::Block& inner) {
  ir::Block block = inner;
  for (unsigned i = 0; i < depth; ++i)
    block = {line(static_cast<std::uint16_t>(100 - i), ir::If{kClose, block, {}})};
  return block;
}

}  // namespace

TEST_CASE("variables, checks and bands travel") {
  ir::Program program = program_of({when(of(Operation::equal, {variable(2), number(1)}), {kLeft})});
  ir::Variable joy = ranged("joy", 0, 100);
  joy.kind = vm::VariableKind::feeling;
  joy.dimension = vm::Dimension::percent;
  joy.initial = 40000;
  joy.fades_to = 50000;
  joy.fade = 123456789;
  ir::Variable mood = ranged("mood", 0, 1);
  mood.kind = vm::VariableKind::state;
  mood.labels = {"calm", "wild"};
  ir::Variable space = ranged("space", 0, 1);
  space.kind = vm::VariableKind::band;
  space.labels = {"close", "far"};
  space.initial = vm::kUnknown;
  ir::Variable agitation = space;  // the same words again
  agitation.name = "agitation";
  program.variables = {joy, mood, space, agitation};
  const vm::Band close{vm::kValueMin, 299, vm::kValueMin, 349};
  const vm::Band far{300, vm::kValueMax, 250, vm::kValueMax};
  program.checks = {{2, channel(1), {close, far}, 5, 20}, {3, variable(0), {close, far}, 1, 0}};
  const Built built = must_build(program);
  const vm::Image& image = built.image;
  REQUIRE(image.variables.size() == 4);
  CHECK(image.string(image.variables[0].name) == "joy");
  CHECK(image.variables[0].kind == vm::VariableKind::feeling);
  CHECK(image.variables[0].dimension == vm::Dimension::percent);
  CHECK(image.variables[0].initial == 40000);
  CHECK(image.variables[0].max == 100000);
  CHECK(image.variables[0].fades_to == 50000);
  CHECK(image.variables[0].fade == 123456789);
  CHECK(image.variables[1].fade == 0);
  CHECK(labels_of(image, image.variables[1].first_label, 2) ==
        std::vector<std::string>{"calm", "wild"});
  CHECK(image.variables[2].initial == vm::kUnknown);
  CHECK(image.variables[2].first_label == image.variables[3].first_label);
  CHECK(image.labels.size() == 4);
  REQUIRE(image.checks.size() == 2);
  CHECK(image.checks[0].variable == 2);
  CHECK(image.checks[0].input == 0);  // the only channel
  CHECK(image.checks[0].window == 5);
  CHECK(image.checks[0].sample_ms == 20);
  CHECK(image.checks[1].input == 1);  // channels, then joy
  CHECK(image.checks[1].first_band == 2);
  CHECK(image.bands[0].stay_high == 349);
  CHECK(image.bands[3].low == 300);
  CHECK(image.inputs[image.behaviors[0].first_input] == 3);
}

TEST_CASE("channels of words have their labels") {
  const Built built =
      must_build(program_of({when(of(Operation::equal, {channel(3), number(1)}), {kLeft})}));
  const vm::Channel& key = built.image.channels[0];
  CHECK(labels_of(built.image, key.first_label, key.label_count) ==
        std::vector<std::string>{"up", "down"});
  CHECK(key.max == 1000);
}

TEST_CASE("rules with the same modifiers share them") {
  ir::Rule rule = when(kClose, {kLeft});
  ir::Rule cooled = rule;
  cooled.cooldown = 20000;
  ir::Rule waiting = rule;
  waiting.waiting = 20000;
  waiting.restarting = true;
  const Built built = must_build(program_of({rule, cooled, waiting, cooled}));
  const vm::Image& image = built.image;
  REQUIRE(image.modifiers.size() == 2);
  CHECK(image.rules[0].modifiers == vm::kNoModifiers);
  CHECK(image.rules[1].modifiers == 0);
  CHECK(image.rules[2].modifiers == 1);
  CHECK(image.rules[3].modifiers == 0);
  CHECK(image.modifiers[0].cooldown == 20000);
  CHECK(image.modifiers[1].waiting == 20000);
  CHECK(image.modifiers[1].restarting == 1);
}

TEST_CASE("code with a timer or a local is not shared, other code is") {
  const ir::Rule plain_rule = when(kClose, {kLeft});
  const ir::Rule timed = when(held(kClose, 1), {kLeft});
  const ir::Rule counting =
      when(kClose, {line(10, ir::Repeat{ir::RepeatKind::times, number(2), {kLeft}})});
  CHECK(must_build(program_of({plain_rule, plain_rule})).image.responses.size() == 1);
  const Built built = must_build(program_of({timed, timed, counting, counting}));
  const vm::Image& image = built.image;
  CHECK(image.rules[0].condition_start != image.rules[1].condition_start);
  CHECK(image.rules[0].then_response == image.rules[1].then_response);
  CHECK(image.timers.size() == 2);
  CHECK(image.rules[2].then_response != image.rules[3].then_response);
}

TEST_CASE("equal time words of a behaviour are watched once, unless they read a local") {
  const auto watches = [](const E& time_word) {
    const ir::Block block = {line(10, ir::Local{0, channel(0)}),
                             line(11, ir::If{time_word, {kLeft}, {}})};
    const Built built = must_build(program_of({at_start(block), at_start(block)}));
    return built.image.timers.size();
  };
  CHECK(watches(held(kClose, 1)) == 1);
  // Local 0 of each response is a cell of its own.
  CHECK(watches(held(less(channel(1), local(0)), 1)) == 2);
}

TEST_CASE("SAFETY comes first and stops what nothing else uses") {
  ir::Program program = program_of({when(kClose, {kLeft})});
  ir::Rule guard = when(kClose, {line(30, ir::Halt{false, 0, {0, 1}})});
  guard.kind = vm::RuleKind::safety;
  program.safety = {guard};
  program.speed_limits = {{0, 30000}, {0, 50000}};
  const Built built = must_build(program);
  const vm::Image& image = built.image;
  REQUIRE(image.behaviors.size() == 2);
  CHECK(image.behaviors[0].priority == vm::kSafetyPriority);
  CHECK(image.behaviors[0].actuators == 3);
  REQUIRE(image.actuators.size() == 2);
  CHECK(image.actuators[0].speed_limit == 30000);
  CHECK(image.actuators[1].speed_limit == vm::kValueMax);
}

TEST_CASE("every statement knows its line, and so does what follows a nested one") {
  const ir::Statement repeat = line(
      11, ir::Repeat{ir::RepeatKind::times, number(2), {line(12, move(0)), line(13, move(1))}});
  const Built built = must_build(program_of({when(kClose, {line(10, move(2)), repeat})}), true);
  std::vector<std::pair<int, int>> lines;
  for (const vm::SourceLine& one : built.image.source_lines)
    lines.emplace_back(one.word, one.line);
  CHECK(lines ==
        std::vector<std::pair<int, int>>{{0, 1}, {2, 10}, {3, 11}, {4, 12}, {5, 13}, {6, 11}});
  CHECK(must_build(program_of({when(kClose, {kLeft})})).image.source_lines.empty());
}

TEST_CASE("the header has the seed that is asked for or the robot's, and the robot's name") {
  CHECK(must_build(program_of({when(kClose, {kLeft})})).image.header->seed == 0);
  Diagnostics diagnostics;
  const ir::Program program = program_of({when(kClose, {kLeft})});
  Robot robot = small_robot();
  robot.seed = 5;
  robot.safety_start_ms = 30;
  const auto header_of = [&](EmitOptions options) {
    const Emitted emitted = emit(program, program, robot, options, diagnostics);
    vm::Image image;
    REQUIRE(vm::view_image(emitted.image, image));
    return *image.header;
  };
  CHECK(header_of({}).seed == 5);
  CHECK(header_of({.seed = 7}).seed == 7);
  CHECK(header_of({}).safety_start_ms == 30);
  CHECK(header_of({}).traits == 0);
  robot.name = "ada";
  const Emitted named = emit(program, program, robot, {}, diagnostics);
  vm::Image image;
  REQUIRE(vm::verify(named.image, {}, image).ok());
  CHECK(image.robot_name() == "ada");
}

TEST_CASE("blocks nest as deeply as the robot allows, and no deeper") {
  CHECK(!build(program_of({when(kClose, nested(vm::kMaxBlocks, {kLeft}))})).bytes.empty());
  expect_too_large(program_of({when(kClose, nested(vm::kMaxBlocks + 1, {kLeft}))}),
                   "blocks are nested more than 16 levels deep", 1000);
  // A chain of IF … ELSE IF takes one block each, and the IF itself another.
  ir::Block chain = {kLeft};
  for (unsigned i = 0; i < vm::kMaxBlocks - 1; ++i)
    chain = {line(static_cast<std::uint16_t>(100 - i), ir::If{kClose, {kLeft}, chain})};
  CHECK(!build(program_of({when(kClose, chain)})).bytes.empty());
  expect_too_large(program_of({when(kClose, {line(5, ir::If{kClose, {kLeft}, chain})})}),
                   "blocks are nested more than 16 levels deep", 1000);
  ir::Pick many;
  for (unsigned i = 0; i < 40; ++i)
    many.options.push_back({1000, {line(7, move(i % 3))}});
  CHECK(!build(program_of({when(kClose, {line(6, many)})})).bytes.empty());
}

TEST_CASE("what does not fit is said in words") {
  std::vector<ir::Variable> variables;
  ir::Block sets;
  for (unsigned i = 0; i <= vm::kMaxWritable; ++i) {
    variables.push_back(plain("v" + std::to_string(i)));
    sets.push_back(line(5, ir::Set{i, number(1), false}));
  }
  expect_too_large(program_of({at_start(sets)}, variables), "33 variables to set");
  sets.pop_back();
  CHECK(!build(program_of({at_start(sets)}, variables)).bytes.empty());

  ir::Block loops;
  for (int i = 0; i < 260; ++i)
    loops.push_back(line(5, ir::Repeat{ir::RepeatKind::times, channel(0), {kWait}}));
  ir::Rule wide = at_start(loops);
  wide.span = {0, 77, 78};
  expect_too_large(program_of({wide}), "cells", 77);

  std::vector<ir::Rule> timed;
  for (int i = 0; i < 200; ++i)
    timed.push_back(when(held(kClose, 1), {kLeft}));
  ir::Program two = program_of(timed);
  two.behaviors.push_back({40, "more", timed});
  expect_too_large(two, "time words");

  timed.assign(300, when(kClose, {kLeft}));
  expect_too_large(program_of(timed), "300 rules");
  ir::Pick heavy;
  for (int i = 0; i < 2; ++i)
    heavy.options.push_back({2'000'000'000, {kLeft}});
  expect_too_large(program_of({when(kClose, {line(6, heavy)})}),
                   "add up to 4000000; the limit is 2147483", 60);

  ir::Block talk;
  for (unsigned i = 0; i < vm::kMaxResponseOutput + 1; ++i)
    talk.push_back(line(static_cast<std::uint16_t>(i), move(0)));
  expect_too_large(program_of({at_start(talk)}), "more than 64 words", 640);
  expect_too_large(
      program_of(
          {at_start({line(8, ir::Repeat{ir::RepeatKind::times,
                                        number(2000000),
                                        {kWait, line(9, ir::Repeat{ir::RepeatKind::times,
                                                                   number(2000000),
                                                                   {line(9, ir::Set{0, number(1),
                                                                                    true})}})}})})},
          {plain("n")}),
      "110000064 instructions on the robot; the limit is 1000000", 80);
  variables.resize(65, plain("w"));
  expect_too_large(program_of({at_start({kLeft})}, variables), "65 channels and variables");
}
