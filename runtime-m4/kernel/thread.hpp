// A thread: what is needed to create one, and what the kernel keeps of it (its control block).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "runtime-m4/kernel/scheduler.hpp"
#include "runtime-m4/kernel/time.hpp"
#include "runtime-m4/kernel/timer_queue.hpp"
#include "runtime-m4/port/port.hpp"

namespace robosync::kernel {

using Events = std::uint32_t;

struct ThreadSpec {
  const char* name = "";  // for reports; must outlive the thread
  Category category = Category::system;
  std::int16_t priority = 0;  // -128 … 127: max over the behaviours that need it (Priority(T))
  void (*entry)(void*) = nullptr;
  void* argument = nullptr;
  std::span<std::byte> stack;  // alignas(port::kStackAlignment), at least port::kMinStack
  // Without privileges it has its stack and what Kernel::grant() gives, and the system calls of
  // calls.def. Its stack: alignas(port::kUnprivilegedStackAlignment), a multiple of that, at most
  // port::kMaxUnprivilegedStack bytes.
  bool privileged = true;
  // Not 0: of the stack, the first so many bytes are data of the thread, which is without privileges;
  // and besides the stack it has nothing, not even what Kernel::grant() gives. The stack is then of
  // port::kSecludedStack bytes and aligned to that.
  std::uint16_t data_bytes = 0;
};

// Unused stack is filled with this, to see later how deep it was used.
inline constexpr std::byte kPaint{0xA5};

// The context stands first: the switch finds it where the thread is.
class Thread : private port::Context, private Timer {
public:
  // How it stands; the numbers are link::ThreadInfo::state.
  enum class State : std::uint8_t { blocked, ready, stopped, absent };

  Thread() = default;
  Thread(const Thread&) = delete;
  Thread& operator=(const Thread&) = delete;

  const char* name() const { return name_; }
  Category category() const { return category_of(standing_); }
  Priority priority() const { return priority_of(standing_); }
  std::uint8_t rank() const { return rank_; }                 // 0 is the highest
  std::uint32_t activations() const { return activations_; }  // times it went to wait
  // Deadlines it missed, as it says itself; 255: that many or more.
  std::uint8_t missed() const { return missed_; }
  void note_miss() {
    if (missed_ != 0xFF) ++missed_;
  }
  // What it can use of its stack.
  std::span<std::byte> stack() const { return {stack_, stack_bytes_}; }
  std::size_t stack_used() const;  // most bytes in use since it was added

private:
  friend class Kernel;

  void set_stack(std::span<std::byte> stack);  // and paints it
  void set_standing(Standing standing) {
    standing_ = standing & ((Standing{1} << kStandingBits) - 1);
  }
  void set_rank(unsigned rank, ReadySet& ready) {
    rank_ = static_cast<std::uint8_t>(rank);
    ready_position_ = ready.position(rank);
  }

  // Takes those of `mask` that are there. [the thread itself]
  Events take(Events mask) { return port::fetch_and_clear(events_, mask) & mask; }

  ReadySet::Position ready_position_;
  Events events_ = 0;  // signalled and not yet taken
  Events wanted_ = 0;  // what it waits for, or waited for last
  std::byte* stack_ = nullptr;
  const char* name_ = "";
  std::uint32_t activations_ = 0;
  std::uint16_t stack_bytes_ = 0;
  std::uint8_t rank_ = kIdleRank;
  std::uint8_t missed_ = 0;
  // Both change under a Lock only, as they share a word.
  Standing standing_ : kStandingBits = 0;
  State state_ : 8 = State::absent;  // or stopped; else the ready set says whether it is blocked
};

}  // namespace robosync::kernel
