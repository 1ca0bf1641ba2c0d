// The timer section under construction: one timer for each time word of the code, in the order of
// the code.
#pragma once

#include <vector>

#include "compiler/ir/program.hpp"

namespace robosync::compiler {

[[nodiscard]] vm::TimerKind timer_kind(Operation time_word);

class Timers {
public:
  // A new timer for the time word; its place.
  [[nodiscard]] std::size_t add(const Expression& time_word);

  [[nodiscard]] const std::vector<vm::Timer>& records() const { return records_; }

private:
  std::vector<vm::Timer> records_;
  std::uint32_t memory_ = 0;  // words that the timers so far need
};

}  // namespace robosync::compiler
