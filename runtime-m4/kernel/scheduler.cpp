// The order of the threads, kept: ranks when a thread comes or goes, and when its priority changes.
// Who outranks whom: scheduler.hpp. The choice of who runs is Kernel::select_next().
#include "runtime-m4/kernel/scheduler.hpp"

#include <utility>

#include "runtime-m4/kernel/kernel.hpp"

namespace robosync::kernel {

// Under a Lock, from add() and remove(): all from `from` on have moved.
void Kernel::shift_ranks(unsigned from) {
  for (unsigned rank = from; rank < count_; ++rank)
    by_rank_[rank]->set_rank(rank, ready_);
  highest_of_.fill(kIdleRank);
  for (unsigned rank = count_; rank-- > 0;)
    highest_of_[index(by_rank_[rank]->category_)] = static_cast<std::uint8_t>(rank);
  ceiling_ = find_ceiling();
  if (running_rank_ != kNoneRuns) running_rank_ = rank_of_running();
}

void Kernel::set_priority(Thread& thread, Priority priority) {
  const bool rises = priority > thread.priority_;
  thread.priority_ = priority;
  if (thread.state_ == Thread::State::absent) return;
  const std::int32_t mine = thread.standing();
  unsigned rank = thread.rank_;
  if (rises) {
    while (rank > 0 && by_rank_[rank - 1]->standing() < mine)
      swap_with_next(--rank);
  } else {
    while (rank + 1 < count_ && by_rank_[rank + 1]->standing() >= mine)
      swap_with_next(rank++);
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
    if (held_ != nullptr) ceiling_ = find_ceiling();
  }
  if (running_rank_ != kNoneRuns) running_rank_ = rank_of_running();
}

}  // namespace robosync::kernel
