// Keeps the order of the threads: updates ranks when a thread is added or removed, or its priority
// changes. A thread is added at the bottom and removed from there, and moves by exchanges of
// neighbours. A SwitchLock covers each change. Interrupts only see the two ranks and their bits in the ready set, so they are held
// off only while those are exchanged.
// Which thread outranks which: scheduler.hpp. Kernel::select_next() chooses the thread that runs.
#include "runtime-m4/kernel/scheduler.hpp"

#include <algorithm>

#include "runtime-m4/kernel/kernel.hpp"

namespace robosync::kernel {

// Adds the thread at the lowest rank. Under a SwitchLock.
void Kernel::enter(Thread& thread) {
  expect().still();
  by_rank_[count_] = &thread;
  thread.set_rank(count_, ready_);
  std::uint8_t& highest = highest_of_[index(thread.category())];
  highest = std::min(highest, count_);
  ++count_;
  follow_highest();
}

// Removes the lowest thread, which must not be ready. Under a SwitchLock.
void Kernel::leave(const Thread& thread) {
  expect().still();
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

// Exchanges the thread at `rank` with the next lower one.
void Kernel::swap_with_next(unsigned rank) {
  port::SwitchLock still(machine_);
  Thread& sinks = *by_rank_[rank];
  Thread& rises = *by_rank_[rank + 1];
  swap_ranks(sinks, rises);
  by_rank_[rank] = &rises;
  by_rank_[rank + 1] = &sinks;
  if (sinks.category() != rises.category()) move_highest(sinks, rises);
  if (&sinks == running_ || &rises == running_) follow_running();
}

inline void Kernel::swap_ranks(Thread& sinks, Thread& rises) {
  port::Lock lock(machine_);
  const ReadySet::Position upper = sinks.ready_position_;
  const ReadySet::Position lower = rises.ready_position_;
  ReadySet::exchange(upper, lower);
  sinks.ready_position_ = lower;
  rises.ready_position_ = upper;
  rises.rank_ = sinks.rank_++;
}

// After an exchange of threads of different categories: the highest rank of one category may be one
// lower now, that of the other one higher. Ceilings follow these ranks.
void Kernel::move_highest(const Thread& sunk, const Thread& risen) {
  std::uint8_t& upper = highest_of_[index(sunk.category())];
  if (upper == risen.rank_) upper = sunk.rank_;
  std::uint8_t& lower = highest_of_[index(risen.category())];
  if (lower == sunk.rank_) lower = risen.rank_;
  follow_highest();
}

// After the highest rank of a category changed: the ceiling may have changed too, and with it the
// rank of the running thread.
void Kernel::follow_highest() {
  if (held_ == nullptr) return;
  ceiling_ = find_ceiling();
  follow_running();
}

// After the rank of the running thread, or its ceiling, may have changed. An interrupt that came since then has compared the rank
// of the thread that it made ready with the old one, so that comparison is made again.
void Kernel::follow_running() {
  if (running_rank_ != kNoneRuns) running_rank_ = rank_of_running();
  if (ready_.first() < running_rank_) machine_.request_switch();
}

}  // namespace robosync::kernel
