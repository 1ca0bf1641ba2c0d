// The order of the threads, kept: ranks when a thread comes or goes, and when its priority changes.
// All of it is done by exchanges of neighbours, each under a Lock of its own, so that interrupts
// are held off for the length of one: a thread comes in at the bottom, and goes from there. Who
// outranks whom: scheduler.hpp. The choice of who runs is Kernel::select_next().
#include "runtime-m4/kernel/scheduler.hpp"

#include <algorithm>
#include <utility>

#include "runtime-m4/kernel/kernel.hpp"

namespace robosync::kernel {

// The thread becomes the lowest of all. Under a Lock.
void Kernel::enter(Thread& thread) {
  by_rank_[count_] = &thread;
  thread.set_rank(count_, ready_);
  std::uint8_t& highest = highest_of_[index(thread.category_)];
  highest = std::min(highest, count_);
  ++count_;
  follow_ranks();
}

// The lowest of all goes; it is not ready. Under a Lock.
void Kernel::leave(const Thread& thread) {
  --count_;
  by_rank_[count_] = &idle_;
  std::uint8_t& highest = highest_of_[index(thread.category_)];
  if (highest == count_) highest = kIdleRank;
  follow_ranks();
}

void Kernel::rise(const Thread& thread) {
  const std::int32_t mine = thread.standing();
  unsigned rank = thread.rank_;
  while (rank > 0 && by_rank_[rank - 1]->standing() < mine)
    swap_with_next(--rank);
}

void Kernel::sink_below(const Thread& thread, std::int32_t standing) {
  unsigned rank = thread.rank_;
  while (rank + 1 < count_ && by_rank_[rank + 1]->standing() >= standing)
    swap_with_next(rank++);
}

void Kernel::set_priority(Thread& thread, Priority priority) {
  const bool rises = priority > thread.priority_;
  thread.priority_ = priority;
  if (thread.state_ == Thread::State::absent) return;
  if (rises) {
    rise(thread);
  } else {
    sink_below(thread, thread.standing());
  }
}

// The threads at `rank` and below it change places. Interrupts are held off for this one exchange.
void Kernel::swap_with_next(unsigned rank) {
  port::Lock lock(machine_);
  Thread& sinks = *by_rank_[rank];
  Thread& rises = *by_rank_[rank + 1];
  const bool rising_ready = ReadySet::contains(rises.ready_place_);
  if (ReadySet::contains(sinks.ready_place_) != rising_ready) {
    ReadySet::toggle(sinks.ready_place_);
    ReadySet::toggle(rises.ready_place_);
  }
  std::swap(sinks.ready_place_, rises.ready_place_);
  sinks.rank_ = static_cast<std::uint8_t>(rank + 1);
  rises.rank_ = static_cast<std::uint8_t>(rank);
  by_rank_[rank] = &rises;
  by_rank_[rank + 1] = &sinks;
  move_highest(sinks, rises);
  // Another thread has to run only if it is ready and this one ran before it; or if it is the
  // holder of a mutex, whose ceiling this may have been.
  if (running_ == &sinks && (rising_ready || held_ != nullptr)) machine_.request_switch();
}

// Of two categories each other's neighbour: the highest of one may now stand a place lower, that of
// the other a place higher, and so may a ceiling.
void Kernel::move_highest(const Thread& sunk, const Thread& risen) {
  if (sunk.category_ != risen.category_) {
    std::uint8_t& upper = highest_of_[index(sunk.category_)];
    if (upper == risen.rank_) upper = sunk.rank_;
    std::uint8_t& lower = highest_of_[index(risen.category_)];
    if (lower == sunk.rank_) lower = risen.rank_;
  }
  follow_ranks();
}

// After a change of ranks: so may ceilings have changed, and the rank of who runs.
void Kernel::follow_ranks() {
  if (held_ != nullptr) ceiling_ = find_ceiling();
  if (running_rank_ != kNoneRuns) running_rank_ = rank_of_running();
}

}  // namespace robosync::kernel
