// Compares what a TEST expects with what happened.
#pragma once

#include <optional>
#include <string>

#include "rsc/trace/recording.hpp"

namespace robosync::tool {

// Nothing if it came as expected; else what was different, in one sentence.
[[nodiscard]] std::optional<std::string> disappointment(
    const compiler::test_plan::Expectation& expectation, const Recording& recording);

struct TestResult {
  const compiler::test_plan::PlannedTest* test = nullptr;
  const compiler::test_plan::Expectation* failed = nullptr;  // the first; null: it passed
  std::string reason;
  Recording recording;
};
[[nodiscard]] TestResult run_test(const Program& program, const compiler::test_plan::TestPlan& plan,
                                  const compiler::test_plan::PlannedTest& test);

}  // namespace robosync::tool
