// The threads of the running program: control blocks and stacks from static memory, given out when
// a program is activated and taken back all at once.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "runtime-m4/kernel/kernel.hpp"
#include "runtime-m4/limits.hpp"

namespace robosync::layers {

class ProgramThreads {
public:
  struct Member {
    kernel::Thread thread;
    std::uint8_t index = 0;  // of its sensor, behaviour or actuator in the image
    bool reported = false;   // its stop was reported
  };

  explicit ProgramThreads(kernel::Kernel& kernel) : kernel_(kernel) {}

  // Adds a thread with a stack of `stack_bytes`; spec.stack is set here. Null, and nothing changed,
  // when there is no place; fits() (program.hpp) rules that out for a program as a whole.
  [[nodiscard]] kernel::Thread* start(kernel::ThreadSpec spec, unsigned index,
                                      std::size_t stack_bytes);
  // Like it, with a control block of the caller's. It is removed by dismiss() as well.
  [[nodiscard]] bool start_step_thread(kernel::Thread& thread, kernel::ThreadSpec spec);
  // Takes all threads out of the kernel. Not from one of them.
  void dismiss();

  // Gives every thread the priority that `priority_of(thread, index)` says, in the order they were
  // started in.
  template <class PriorityOf>
  void rank(PriorityOf priority_of) {
    for (Member& member : std::span(members_).first(count_))
      kernel_.set_priority(member.thread, priority_of(member.thread, member.index));
    kernel_.set_priority(*step_thread_, priority_of(*step_thread_, 0));
  }

  // A thread that was stopped and not returned before; null when there is none.
  Member* next_stopped();
  // How many of them were ever stopped.
  unsigned stopped() const;

private:
  std::span<std::byte> take_stack(std::size_t bytes, bool privileged);

  kernel::Kernel& kernel_;
  std::array<Member, kMaxProgramThreads - 1> members_;
  kernel::Thread* step_thread_ = nullptr;
  std::size_t count_ = 0;
  // Stacks of threads with privileges from the beginning on, of those without from the end down:
  // these must be aligned, and so they are if the arena and their sizes are.
  std::size_t stack_used_ = 0;
  std::size_t unprivileged_stack_used_ = 0;
  static_assert(kStackArena % port::kUnprivilegedStackAlignment == 0);
  static_assert(kBehaviorStack % port::kUnprivilegedStackAlignment == 0);
  static_assert(kBehaviorStack <= port::kMaxUnprivilegedStack);
  alignas(port::kUnprivilegedStackAlignment) std::array<std::byte, kStackArena> stacks_{};
};

}  // namespace robosync::layers
