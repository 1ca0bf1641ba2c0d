// One run of a TEST: everything that a new robot did in virtual time when fed with the test's
// readings.
#pragma once

#include <cstdint>
#include <vector>

#include "compiler/test_plan/evaluate.hpp"
#include "compiler/test_plan/plan.hpp"
#include "link/events.hpp"
#include "link/messages.hpp"
#include "rsc/program.hpp"

namespace robosync::tool {

struct Recording {
  const vm::Image* image = nullptr;
  const Origin* origin = nullptr;
  const compiler::test_plan::TestPlan* plan = nullptr;
  const compiler::test_plan::PlannedTest* test = nullptr;
  std::vector<link::Event> events;        // in the order they happened
  std::vector<link::ThreadInfo> threads;  // when the first event named a thread; else empty
  // Values that no sample of their sensor measured.
  std::vector<const compiler::test_plan::PlannedReading*> unseen;
};

// `program` and `plan` must outlive the result. Throws Failure (program) if the robot refuses the
// program.
[[nodiscard]] Recording record(const Program& program, const compiler::test_plan::TestPlan& plan,
                               const compiler::test_plan::PlannedTest& test);

// Steps through a recording and knows the values at each moment.
class Playback final : public compiler::test_plan::Moment {
public:
  explicit Playback(const Recording& recording);

  // The next event, which takes effect immediately; nullptr at the end.
  const link::Event* next();
  // All events up to program time `until_us`, inclusive.
  void advance(std::uint64_t until_us);
  // The time of the next step with an event or a reading; UINT64_MAX: never.
  std::uint64_t next_time() const;

  vm::Value channel(compiler::ChannelRef channel) const override;
  vm::Value variable(std::size_t index) const override;
  vm::Value time() const override;

private:
  const Recording& recording_;
  std::size_t at_ = 0;
  std::uint64_t now_us_ = 0;
  std::vector<vm::Value> channels_;   // by number in the image
  std::vector<vm::Value> variables_;  // also by number
};

}  // namespace robosync::tool
