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
    highest_of_[index(by_rank_[rank]->category())] = static_cast<std::uint8_t>(rank);
  ceiling_ = find_ceiling();
  if (running_rank_ != kNoneRuns) running_rank_ = rank_of_running();
}

void Kernel::set_priority(Thread& thread, Priority priority) {
  const Standing before = thread.standing_;
  const Standing mine = standing(thread.category(), priority);
  {
    port::Lock lock(machine_);
    thread.set_standing(mine);
  }
  if (thread.state_ == Thread::State::absent) return;
  unsigned rank = thread.rank_;
  if (mine > before) {
    while (rank > 0 && by_rank_[rank - 1]->standing_ < mine)
      swap_with_next(--rank);
  } else {
    while (rank + 1 < count_ && by_rank_[rank + 1]->standing_ >= mine)
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
  if (sinks.category() != rises.category()) move_highest(sinks, rises);
  if (running_ == &sinks || running_ == &rises) running_moved(rising_ready);
}

// Two of different categories have changed places: the highest of one may now stand a place lower,
// that of the other a place higher, and so may a ceiling.
void Kernel::move_highest(const Thread& sunk, const Thread& risen) {
  std::uint8_t& upper = highest_of_[index(sunk.category())];
  if (upper == risen.rank_) upper = sunk.rank_;
  std::uint8_t& lower = highest_of_[index(risen.category())];
  if (lower == sunk.rank_) lower = risen.rank_;
  ceiling_ = find_ceiling();
}

// The running thread has changed places with another: with one that can run, it may be its turn;
// and so it may be the turn of who holds a mutex, if its ceiling was the place.
void Kernel::running_moved(bool other_ready) {
  if (running_rank_ == kNoneRuns) return;
  const std::uint8_t before = running_rank_;
  running_rank_ = rank_of_running();
  if (running_rank_ > before && (other_ready || held_ != nullptr)) machine_.request_switch();
}

}  // namespace robosync::kernel
