// The order of the threads, kept: ranks when a thread comes or goes, and when its priority changes.
// All of it is done by exchanges of neighbours, each under a Lock of its own, so that interrupts
// are held off for the length of one: a thread comes in at the bottom, and goes from there. Who
// outranks whom: scheduler.hpp. The choice of who runs is Kernel::select_next().
#include "runtime-m4/kernel/scheduler.hpp"

#include <algorithm>

#include "runtime-m4/kernel/kernel.hpp"

namespace robosync::kernel {

// The thread becomes the lowest of all. Under a Lock.
void Kernel::enter(Thread& thread) {
  expect().locked();
  by_rank_[count_] = &thread;
  thread.set_rank(count_, ready_);
  std::uint8_t& highest = highest_of_[index(thread.category())];
  highest = std::min(highest, count_);
  ++count_;
  follow_highest();
}

// The lowest of all goes; it is not ready. Under a Lock.
void Kernel::leave(const Thread& thread) {
  expect().locked();
  --count_;
  by_rank_[count_] = &idle_;
  std::uint8_t& highest = highest_of_[index(thread.category())];
  if (highest == count_) highest = kIdleRank;
  follow_highest();
}

void Kernel::rise(const Thread& thread) {
  const Standing mine = thread.standing_;
  unsigned rank = thread.rank_;
  while (rank > 0 && by_rank_[rank - 1]->standing_ < mine)
    swap_with_next(--rank);
}

void Kernel::sink_below(const Thread& thread, Standing standing) {
  unsigned rank = thread.rank_;
  while (rank + 1 < count_ && by_rank_[rank + 1]->standing_ >= standing)
    swap_with_next(rank++);
}

void Kernel::set_priority(Thread& thread, Priority priority) {
  expect().no_handler();
  const Standing before = thread.standing_;
  const Standing mine = with_priority(before, priority);
  {
    port::Lock lock(machine_);
    thread.set_standing(mine);
  }
  if (thread.state_ == Thread::State::absent) return;
  if (mine > before) {
    rise(thread);
  } else {
    sink_below(thread, mine);
  }
}

// The threads at `rank` and below it change places. Interrupts are held off for this one exchange.
void Kernel::swap_with_next(unsigned rank) {
  port::Lock lock(machine_);
  Thread& sinks = *by_rank_[rank];
  Thread& rises = *by_rank_[rank + 1];
  const ReadySet::Position upper = sinks.ready_position_;
  const ReadySet::Position lower = rises.ready_position_;
  const bool rising_ready = ReadySet::exchange(upper, lower);
  sinks.ready_position_ = lower;
  rises.ready_position_ = upper;
  sinks.rank_ = static_cast<std::uint8_t>(rank + 1);
  rises.rank_ = static_cast<std::uint8_t>(rank);
  by_rank_[rank] = &rises;
  by_rank_[rank + 1] = &sinks;
  if (sinks.category() != rises.category()) move_highest(sinks, rises);
  if (running_ == &rises) follow_running();
  if (running_ == &sinks) {
    follow_running();
    // The other's turn, if it can run; or that of who holds a mutex whose ceiling this was.
    if (rising_ready || held_ != nullptr) machine_.request_switch();
  }
}

// Two of different categories have changed places: the highest of one may now stand a place lower,
// that of the other a place higher, and so may a ceiling.
void Kernel::move_highest(const Thread& sunk, const Thread& risen) {
  std::uint8_t& upper = highest_of_[index(sunk.category())];
  if (upper == risen.rank_) upper = sunk.rank_;
  std::uint8_t& lower = highest_of_[index(risen.category())];
  if (lower == sunk.rank_) lower = risen.rank_;
  follow_highest();
}

// After a change of the highest of a category: so may the ceiling have changed, and with it the
// rank of who runs.
void Kernel::follow_highest() {
  if (held_ == nullptr) return;
  ceiling_ = find_ceiling();
  follow_running();
}

void Kernel::follow_running() {
  if (running_rank_ != kNoneRuns) running_rank_ = rank_of_running();
}

}  // namespace robosync::kernel
