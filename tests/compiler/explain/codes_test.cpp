// `rsc explain CODE`: every diagnostic has its text, and the examples are true.
#include "compiler/explain/codes.hpp"

#include <algorithm>
#include <set>

#include <catch2/catch.hpp>

#include "compiler/compiler.hpp"
#include "compiler/diagnostics/render.hpp"
#include "rsc/algorithm_modules.hpp"
#include "rsc/judge.hpp"

using namespace robosync::compiler;
using Catch::Contains;

namespace {

constexpr const char* kRobot = R"({
  "sensors": [
    {"name": "touch", "type": "VIRTUAL", "channels": {"LEVEL": {"range": [0, 10]}}},
    {"name": "proximity", "type": "VIRTUAL",
     "channels": {"DISTANCE": {"unit": "cm", "range": [2, 400], "rate": "20Hz"}}},
    {"name": "microphone", "type": "VIRTUAL",
     "channels": {"VOLUME": {"unit": "%", "range": [0, 100]}}}
  ],
  "actuators": [
    {"name": "left_arm", "type": "PWM", "pin": 10, "device": "servo", "range": ["0deg", "120deg"]},
    {"name": "right_arm", "type": "PWM", "pin": 11, "device": "servo", "range": ["0deg", "120deg"]},
    {"name": "sound", "type": "VIRTUAL", "device": "speaker",
     "sounds": ["greeting.wav", "warning.wav"]},
    {"name": "face", "type": "VIRTUAL", "device": "face"},
    {"name": "base", "type": "VIRTUAL", "device": "drive"}
  ],
  "groups": {"arms": ["left_arm", "right_arm"]}
})";
constexpr const char* kProgram = "WHEN touch LEVEL > 3 DO\n  LOG \"touched\"\nEND\n";

struct Outcome {
  std::set<Code> codes;
  std::size_t errors = 0;
  std::string text;
};

// RSL with a robot that has some of everything; or a robot.json, with its program behind an empty line, or one for any robot.
Outcome compile_example(std::string_view example) {
  const bool json = example.starts_with('{');
  const std::size_t gap = json ? example.find("\n\n") : std::string_view::npos;
  const bool both = gap != std::string_view::npos;
  const std::string program(both ? example.substr(gap + 2) : example);
  Result result = compile({"robot.rsl", json && !both ? kProgram : program + "\n"},
                          {"robot.json", json ? std::string(example.substr(0, gap)) : kRobot},
                          {.algorithms = robosync::tool::algorithm_modules()});
  robosync::tool::judge(result, robosync::tool::Judged::by_time);
  Outcome outcome{
      {}, result.diagnostics.errors(), render_human(result.diagnostics, result.sources, false)};
  for (const Diagnostic& diagnostic : result.diagnostics.all())
    outcome.codes.insert(diagnostic.code);
  return outcome;
}

}  // namespace

TEST_CASE("every diagnostic is explained, exactly once") {
  const auto count = [](Code code) {
    return std::ranges::count(explain::code_texts(), code, &explain::CodeText::code);
  };
#define DIAGNOSTIC(code, level, title) \
  {                                    \
    INFO(#code);                       \
    CHECK(count(Code::code) == 1);     \
  }
#include "compiler/diagnostics/diagnostics.def"
#undef DIAGNOSTIC
  for (const explain::CodeText& text : explain::code_texts()) {
    INFO(code_name(text.code));
    CHECK(text.meaning.size() > 20);
    CHECK((!text.wrong.empty() || text.mended.empty()));
    // Each has a program that shows it, but for a bug of rsc and for what takes more than a page.
    CHECK(text.wrong.empty() == (text.code == Code::E0013 || text.code == Code::E0499));
    CHECK(text.mended.empty() == (text.wrong.empty() || text.code == Code::E0211));
  }
}

TEST_CASE("the example gets its diagnostic, and the mended one does not") {
  for (const explain::CodeText& text : explain::code_texts()) {
    if (text.wrong.empty()) continue;
    const Outcome wrong = compile_example(text.wrong);
    const Outcome mended = compile_example(text.mended);
    CAPTURE(code_name(text.code), text.wrong, wrong.text, text.mended, mended.text);
    CHECK(wrong.codes.contains(text.code));
    if (text.mended.empty()) continue;
    CHECK_FALSE(mended.codes.contains(text.code));
    CHECK(mended.errors == 0);
  }
}

TEST_CASE("a code is found in any case, and its text has all parts") {
  CHECK(explain::find_code("e0301") == Code::E0301);
  CHECK_FALSE(explain::find_code("E9999"));
  CHECK_FALSE(explain::find_code(""));
  const std::string text = explain::code_text(Code::E0301);
  CHECK_THAT(text, Contains("E0301 (error): units of different kinds\n") &&
                       Contains("For example:\n\n    WHEN proximity DISTANCE < 20N DO\n") &&
                       Contains("Correct:\n\n    WHEN proximity DISTANCE < 20cm DO\n"));
}
