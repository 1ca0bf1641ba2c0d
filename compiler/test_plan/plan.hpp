// TEST blocks, checked and translated: what the sensors measure when, and what is expected then.
// Names are those of robot.json; whoever runs a plan finds them in the program's image.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "compiler/ir/program.hpp"
#include "compiler/sema/names.hpp"

namespace robosync::compiler::test_plan {

using Milliseconds = std::uint32_t;  // of program time; each TEST starts a new robot at 0

// The longest TEST: an hour of the robot's time takes seconds of ours.
inline constexpr Milliseconds kLongestTest = 3'600'000;

struct ChannelName {
  std::string sensor, channel;
};

struct PlannedReading {
  Milliseconds at = 0;
  ChannelRef channel;
  vm::Value value = 0;
};

// A command, matched by what is written of it: verb, word and parameters.
struct ExpectedCommand {
  bool no = false;
  std::vector<std::string> actuators;  // every one of them; of NO, none
  std::string verb;
  std::optional<std::string> word;      // nothing: any
  std::vector<ir::Argument> arguments;  // only those that are written are compared
  std::optional<std::uint32_t> times;   // exactly so often; else once or more
};
// What LOG or ALERT wrote. Where it goes on behind these words, that may be anything.
struct ExpectedText {
  bool no = false;
  bool alert = false;
  std::string text;
};
// They were halted by safety, stopped by STOP, or their commands were cancelled.
struct ExpectedStop {
  bool no = false;
  std::vector<std::string> actuators;
};
struct ExpectedSilence {};  // no command at all
struct ExpectedTruth {      // at the beginning or in some step of the window
  Expression condition;
};

struct Expectation {
  Span span;
  Milliseconds from = 0;  // the window, both ends included
  Milliseconds until = 0;
  std::variant<ExpectedCommand, ExpectedText, ExpectedStop, ExpectedSilence, ExpectedTruth> what;
};

struct PlannedTest {
  std::string title;
  Span span;
  std::vector<PlannedReading> readings;
  std::vector<Expectation> expectations;
  Milliseconds end = 0;               // nothing that is expected lies behind it
  std::optional<std::uint32_t> seed;  // of what is drawn by chance; else the program's
};

struct TestPlan {
  std::vector<PlannedTest> tests;
  std::map<ChannelRef, ChannelName> channels;  // every channel that the tests name
};

// The TEST blocks of the program itself, which is the first of `trees`; it must be free of errors.
// Tests with mistakes, which are reported, are left out.
[[nodiscard]] TestPlan plan_tests(const Trees& trees, const Robot& robot, Diagnostics& diagnostics);

}  // namespace robosync::compiler::test_plan
