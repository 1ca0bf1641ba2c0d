// See program_threads.hpp.
#include "runtime-m4/layers/program_threads.hpp"

namespace robosync::layers {

using kernel::Category;
using policy::Part;

// The stacks of unprivileged threads come first: the end of the closed parts is aligned as they
// require, and the stacks of algorithms are at the very end.
void ProgramThreads::take_stacks(Memory& memory) {
  static_assert(policy::kStackUnit % port::kUnprivilegedStackAlignment == 0);
  static_assert(policy::kBehaviorStack % port::kUnprivilegedStackAlignment == 0);
  static_assert(policy::kBehaviorStack <= port::kMaxUnprivilegedStack);
  static_assert((policy::kSensorStack | policy::kControlStack | policy::kStepStack) %
                    policy::kStackUnit ==
                0);
  algorithms_.stacks = memory.take_bytes(Part::algorithm_stacks);
  behaviors_.stacks = memory.take_bytes(Part::behavior_stacks);
  sensors_.stacks = memory.take_bytes(Part::sensor_stacks);
  controls_.stacks = memory.take_bytes(Part::control_stacks);
  step_stack_ = memory.take_bytes(Part::step_stack);
}

void ProgramThreads::take_members(Memory& memory) {
  algorithms_.members = memory.take<Part::algorithm_threads, Member>();
  behaviors_.members = memory.take<Part::behavior_threads, Member>();
  sensors_.members = memory.take<Part::sensor_threads, Member>();
  controls_.members = memory.take<Part::control_threads, Member>();
}

ProgramThreads::Places& ProgramThreads::places(Category category) {
  if (category == Category::sensor) return sensors_;
  if (category == Category::algorithm) return algorithms_;
  return category == Category::behavior ? behaviors_ : controls_;
}

kernel::Thread* ProgramThreads::start(kernel::ThreadSpec spec, unsigned index) {
  Places& mine = places(spec.category);
  if (mine.used == mine.members.size()) return nullptr;
  if (spec.stack.empty()) {
    const std::size_t bytes = mine.stacks.size() / mine.members.size();
    spec.stack = mine.stacks.subspan(mine.used * bytes, bytes);
  }
  Member& member = mine.members[mine.used];
  if (!kernel_.add(member.thread, spec)) return nullptr;
  ++mine.used;
  member.index = static_cast<std::uint8_t>(index);
  (last_ != nullptr ? last_->next : first_) = &member;
  last_ = &member;
  return &member.thread;
}

bool ProgramThreads::start_step_thread(kernel::Thread& thread, kernel::ThreadSpec spec) {
  spec.stack = step_stack_;
  if (!kernel_.add(thread, spec)) return false;
  step_thread_ = &thread;
  return true;
}

void ProgramThreads::keep_at(const kernel::Thread& thread, kernel::Priority priority) {
  for (Member* member = first_; member != nullptr; member = member->next) {
    if (&member->thread != &thread) continue;
    member->kept = true;
    kernel_.set_priority(member->thread, priority);
  }
}

void ProgramThreads::dismiss() {
  for (Member* member = first_; member != nullptr; member = member->next)
    kernel_.remove(member->thread);
  if (step_thread_ != nullptr) kernel_.remove(*step_thread_);
  step_thread_ = nullptr;
  forget();
}

// A control block may own something that the port keeps elsewhere.
void ProgramThreads::forget() {
  for (Places* const places : {&algorithms_, &sensors_, &behaviors_, &controls_}) {
    for (Member& member : places->members)
      member.~Member();
    *places = {};
  }
  first_ = nullptr;
  last_ = nullptr;
}

ProgramThreads::Member* ProgramThreads::next_stopped() {
  for (Member* member = first_; member != nullptr; member = member->next) {
    if (member->reported || kernel_.state(member->thread) != kernel::Thread::State::stopped)
      continue;
    member->reported = true;
    return member;
  }
  return nullptr;
}

unsigned ProgramThreads::stopped() const {
  unsigned count = 0;
  for (const Member* member = first_; member != nullptr; member = member->next)
    if (kernel_.state(member->thread) == kernel::Thread::State::stopped) ++count;
  if (step_thread_ != nullptr && kernel_.state(*step_thread_) == kernel::Thread::State::stopped)
    ++count;
  return count;
}

}  // namespace robosync::layers
