#include "compiler/codegen/timers.hpp"

#include "vm/timers.hpp"

namespace robosync::compiler {

vm::TimerKind timer_kind(Operation time_word) {
  switch (time_word) {
    case Operation::held:
      return vm::TimerKind::held;
    case Operation::counted:
      return vm::TimerKind::counted;
    case Operation::sequence:
      return vm::TimerKind::sequence;
    case Operation::latch:
      return vm::TimerKind::latch;
    case Operation::rose:
      return vm::TimerKind::rose;
    default:
      return vm::TimerKind::changed;
  }
}


std::size_t Timers::add(const Expression& time_word) {
  vm::Timer timer{};
  timer.kind = timer_kind(time_word.operation);
  if (vm::info_of(timer.kind).counts) timer.count = static_cast<std::uint8_t>(time_word.index);
  timer.state = static_cast<std::uint16_t>(memory_);
  if (timer.kind != vm::TimerKind::latch && timer.kind != vm::TimerKind::rose)
    timer.duration = time_word.constant;
  memory_ += vm::timer_words(timer);
  records_.push_back(timer);
  return records_.size() - 1;
}

}  // namespace robosync::compiler
