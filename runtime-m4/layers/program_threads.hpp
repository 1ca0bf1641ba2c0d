// The threads of the running program: control blocks and stacks from the arena, handed out when a
// program is activated and taken back together.
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
    std::uint8_t index = 0;  // in the image: of its sensor, behaviour or actuator
    bool reported = false;   // its stop was reported
    bool kept = false;       // keep_at()
    Member* next = nullptr;  // the one started next
  };

  explicit ProgramThreads(kernel::Kernel& kernel) : kernel_(kernel) {}
  ~ProgramThreads() { forget(); }
  ProgramThreads(const ProgramThreads&) = delete;
  ProgramThreads& operator=(const ProgramThreads&) = delete;

  // Takes the places for the program of `memory`. There must be no program threads.
  void take_stacks(Memory& memory);
  void take_members(Memory& memory);
  // Starts a thread in a free place of its category and sets its stack, unless it has one. Returns null, and changes
  // nothing, if there is no place; a program that memory is laid out for never causes that.
  [[nodiscard]] kernel::Thread* start(kernel::ThreadSpec spec, unsigned index);
  // Like start(), with the caller's control block. dismiss() removes this thread as well.
  [[nodiscard]] bool start_step_thread(kernel::Thread& thread, kernel::ThreadSpec spec);
  // The stack of an algorithm's thread: so many bytes, and so far above the lowest one.
  [[nodiscard]] std::span<std::byte> algorithm_stack(std::uint32_t above,
                                                     std::uint32_t bytes) const {
    return algorithms_.stacks.subspan(above, bytes);
  }
  // Removes all threads from the kernel. Not to be called from one of them.
  void dismiss();

  // Fixes the priority of one of them, whatever rank() says.
  void keep_at(const kernel::Thread& thread, kernel::Priority priority);
  // Gives every other thread the priority that `priority_of(thread, index)` returns, in the order in which
  // they were started.
  template <class PriorityOf>
  void rank(PriorityOf priority_of) {
    for (Member* member = first_; member != nullptr; member = member->next)
      if (!member->kept)
        kernel_.set_priority(member->thread, priority_of(member->thread, member->index));
    kernel_.set_priority(*step_thread_, priority_of(*step_thread_, 0));
  }

  // A stopped thread that was not returned before; null if there is none.
  Member* next_stopped();
  // How many of them have been stopped.
  unsigned stopped() const;

private:
  // For one category: control blocks, their consecutive stacks, and how many are in use.
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
  Member* first_ = nullptr;  // of all, in the order in which they were started
  Member* last_ = nullptr;
};

}  // namespace robosync::layers
