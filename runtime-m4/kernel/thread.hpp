// A thread: the specification it is created from, and its control block.
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
  std::int16_t priority = 0;  // -128 … 127: highest of the behaviours that need it (Priority(T))
  void (*entry)(void*) = nullptr;
  void* argument = nullptr;
  std::span<std::byte> stack;  // alignas(port::kStackAlignment), at least port::kMinStack
  // An unprivileged thread can access its stack and what Kernel::grant() gives, and make the system
  // calls of calls.def. Its stack: alignas(port::kUnprivilegedStackAlignment), a multiple of that,
  // at most port::kMaxUnprivilegedStack bytes.
  bool privileged = true;
  // If not 0, this many bytes at the start of the stack are the thread's data. The thread must be
  // unprivileged, and can access its stack only, not even what Kernel::grant() gives. The stack is then
  // exactly what eighths of one MPU region cover (policy/regions.hpp).
  std::uint16_t data_bytes = 0;
};

// Fills unused stack, so that stack_used() can tell later how much of it was used.
inline constexpr std::byte kPaint{0xA5};

// The context comes first: switch.S takes a thread's address as that of its context.
class Thread : private port::Context, private Timer {
public:
  // The numbers are those of link::ThreadInfo::state.
  enum class State : std::uint8_t { blocked, ready, stopped, absent };

  Thread() = default;
  Thread(const Thread&) = delete;
  Thread& operator=(const Thread&) = delete;

  const char* name() const { return name_; }
  Category category() const { return category_of(standing_); }
  Priority priority() const { return priority_of(standing_); }
  std::uint8_t rank() const { return rank_; }                 // 0 is the highest
  std::uint32_t activations() const { return activations_; }  // times it blocked
  // Deadlines it missed, as it reports them itself; saturates at 255.
  std::uint8_t missed() const { return missed_; }
  void note_miss() {
    if (missed_ != 0xFF) ++missed_;
  }
  // The usable part of its stack.
  std::span<std::byte> stack() const { return {stack_, stack_bytes_}; }
  std::size_t stack_used() const;  // most bytes in use since it was added

private:
  friend class Kernel;

  void set_stack(std::span<std::byte> stack);  // also paints it
  void set_standing(Standing standing) {
    standing_ = standing & ((Standing{1} << kStandingBits) - 1);
  }
  void set_rank(unsigned rank, ReadySet& ready) {
    rank_ = static_cast<std::uint8_t>(rank);
    ready_position_ = ready.position(rank);
  }

  // Takes the signalled events of `mask`. [the thread itself]
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
  // Both change under a Lock only, because they share a word.
  Standing standing_ : kStandingBits = 0;
  State state_ : 8 = State::absent;  // never blocked: the ready set tells ready from blocked
};

}  // namespace robosync::kernel
