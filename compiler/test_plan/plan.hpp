// TEST blocks, checked and translated: which readings the sensors have at which times, and what is expected then. Names are those
// of robot.json; the test runner looks them up in the program's image.
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

// The longest TEST. An hour on the robot takes seconds to run.
inline constexpr Milliseconds kLongestTest = 3'600'000;

struct ChannelName {
  std::string sensor, channel;
};

struct PlannedReading {
  Milliseconds at = 0;
  ChannelRef channel;
  vm::Value value = 0;
  Span span{};  // of its step
};

// A command, matched by the parts that are written: verb, word and parameters.
struct ExpectedCommand {
  bool no = false;
  std::vector<std::string> actuators;  // all of them must get it; with NO: none of them may
  std::string verb;
  std::optional<std::string> word;      // nullopt: any
  std::vector<ir::Argument> arguments;  // only those that are written are compared
  std::optional<std::uint32_t> times;   // exactly this often; nullopt: at least once
  bool is_text = false;                 // the word is a text: upper and lower case differ
};
// Text that LOG or ALERT wrote. Anything may follow these words.
struct ExpectedText {
  bool no = false;
  bool alert = false;
  std::string text;
};
// The actuators were halted by safety, stopped by STOP, or their commands were cancelled.
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
  Milliseconds from = 0;  // the window, including both ends
  Milliseconds until = 0;
  std::variant<ExpectedCommand, ExpectedText, ExpectedStop, ExpectedSilence, ExpectedTruth> what;
};

struct PlannedTest {
  std::string title;
  Span span;
  std::vector<PlannedReading> readings;
  std::vector<Expectation> expectations;
  Milliseconds end = 0;               // no expectation is later than this
  std::optional<std::uint32_t> seed;  // of the random numbers; nullopt: the program's
};

struct TestPlan {
  std::vector<PlannedTest> tests;
  std::map<ChannelRef, ChannelName> channels;  // every channel that the tests name
};

// The TEST blocks of the program itself, the first of `trees`, which must be free of errors. Tests with mistakes are reported and
// left out.
[[nodiscard]] TestPlan plan_tests(const Trees& trees, const Robot& robot, const SourceMap& sources,
                                  Diagnostics& diagnostics);

}  // namespace robosync::compiler::test_plan
