// See threads.hpp.
#include "runtime-m4/layers/program_threads.hpp"

#include <algorithm>

namespace robosync::layers {

std::span<std::byte> ProgramThreads::take_stack(std::size_t bytes, bool privileged) {
  const std::size_t free = stacks_.size() - stack_used_ - unprivileged_stack_used_;
  if (bytes > free) return {};
  std::size_t& used = privileged ? stack_used_ : unprivileged_stack_used_;
  used += bytes;
  return std::span(stacks_).subspan(privileged ? used - bytes : stacks_.size() - used, bytes);
}

kernel::Thread* ProgramThreads::start(kernel::ThreadSpec spec, unsigned index,
                                      std::size_t stack_bytes) {
  if (count_ == members_.size()) return nullptr;
  spec.stack = take_stack(stack_bytes, spec.privileged);
  if (spec.stack.empty()) return nullptr;
  Member& member = members_[count_];
  if (!kernel_.add(member.thread, spec)) return nullptr;
  member.index = static_cast<std::uint8_t>(index);
  member.reported = false;
  ++count_;
  return &member.thread;
}

bool ProgramThreads::start_step_thread(kernel::Thread& thread, kernel::ThreadSpec spec) {
  spec.stack = take_stack(kStepStack, spec.privileged);
  if (spec.stack.empty() || !kernel_.add(thread, spec)) return false;
  step_thread_ = &thread;
  return true;
}

void ProgramThreads::dismiss() {
  for (Member& member : std::span(members_).first(count_))
    kernel_.remove(member.thread);
  if (step_thread_ != nullptr) kernel_.remove(*step_thread_);
  step_thread_ = nullptr;
  count_ = 0;
  stack_used_ = 0;
  unprivileged_stack_used_ = 0;
}

ProgramThreads::Member* ProgramThreads::next_stopped() {
  for (Member& member : std::span(members_).first(count_)) {
    if (member.reported || kernel_.state(member.thread) != kernel::Thread::State::stopped) continue;
    member.reported = true;
    return &member;
  }
  return nullptr;
}

unsigned ProgramThreads::stopped() const {
  unsigned count = 0;
  for (const Member& member : std::span(members_).first(count_))
    if (kernel_.state(member.thread) == kernel::Thread::State::stopped) ++count;
  if (step_thread_ != nullptr && kernel_.state(*step_thread_) == kernel::Thread::State::stopped)
    ++count;
  return count;
}

}  // namespace robosync::layers
