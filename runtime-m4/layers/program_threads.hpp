// The threads of the running program: control blocks and stacks from the arena, given out when a
// program is activated and taken back all at once.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "runtime-m4/kernel/kernel.hpp"
#include "runtime-m4/layers/memory.hpp"

namespace robosync::layers {

class ProgramThreads {
public:
  struct Member {
    kernel::Thread thread;
    std::uint8_t index = 0;  // of its sensor, behaviour or actuator in the image
    bool reported = false;   // its stop was reported
    bool kept = false;       // keep_at()
    Member* next = nullptr;  // started after it
  };

  explicit ProgramThreads(kernel::Kernel& kernel) : kernel_(kernel) {}
  ~ProgramThreads() { forget(); }
  ProgramThreads(const ProgramThreads&) = delete;
  ProgramThreads& operator=(const ProgramThreads&) = delete;

  // No thread of a program is there. The places of `memory`'s program are the ones to fill.
  void take_stacks(Memory& memory);
  void take_members(Memory& memory);
  // Adds a thread in a place of its category; its stack is set here. Null, and nothing changed,
  // when there is none, which no program can cause that memory is laid out for.
  [[nodiscard]] kernel::Thread* start(kernel::ThreadSpec spec, unsigned index);
  // Like it, with a control block of the caller's. It is removed by dismiss() as well.
  [[nodiscard]] bool start_step_thread(kernel::Thread& thread, kernel::ThreadSpec spec);
  // Where the data of the algorithm's thread begins that is started next, or null.
  [[nodiscard]] std::byte* next_algorithm_data() const {
    return algorithms_.stacks.data() + algorithms_.used * policy::kAlgorithmStack;
  }
  // Takes all threads out of the kernel. Not from one of them.
  void dismiss();

  // One of them has this priority from now on, whatever rank() says.
  void keep_at(const kernel::Thread& thread, kernel::Priority priority);
  // Gives every other thread the priority that `priority_of(thread, index)` says, in the order they were
  // started in.
  template <class PriorityOf>
  void rank(PriorityOf priority_of) {
    for (Member* member = first_; member != nullptr; member = member->next)
      if (!member->kept)
        kernel_.set_priority(member->thread, priority_of(member->thread, member->index));
    kernel_.set_priority(*step_thread_, priority_of(*step_thread_, 0));
  }

  // A thread that was stopped and not returned before; null when there is none.
  Member* next_stopped();
  // How many of them were ever stopped.
  unsigned stopped() const;

private:
  // Of one category: control blocks, their stacks one behind the other, and how many are in use.
  struct Places {
    std::span<Member> members;
    std::span<std::byte> stacks;
    std::size_t used = 0;
  };

  Places& places(kernel::Category category);
  void forget();

  kernel::Kernel& kernel_;
  Places algorithms_, sensors_, behaviors_, controls_;
  std::span<std::byte> step_stack_;
  kernel::Thread* step_thread_ = nullptr;
  Member* first_ = nullptr;  // of all, in the order they were started in
  Member* last_ = nullptr;
};

}  // namespace robosync::layers
