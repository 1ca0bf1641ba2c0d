// Which threads there are: creation, removal, ranks. Bounded: a change moves at most kMaxThreads
// places. Built for size; what is in a hurry stands in kernel.cpp.
#include <algorithm>

#include "runtime-m4/kernel/kernel.hpp"

namespace robosync::kernel {

namespace {

[[gnu::always_inline]] inline std::int32_t standing(const Thread& thread) {
  return standing(thread.category(), thread.priority());
}

}  // namespace

bool Kernel::add(Thread& thread, const ThreadSpec& spec) {
  if (thread.state_ != Thread::State::absent || count_ == kMaxThreads) return false;
  if (spec.entry == nullptr || spec.stack.size() < port::kMinStack) return false;
  const auto priority = static_cast<std::int8_t>(spec.priority);
  if (spec.stack.size() > 0xFFFF || priority != spec.priority) return false;
  thread.name_ = spec.name;
  thread.category_ = spec.category;
  thread.priority_ = {priority, priority};
  thread.set_stack(port::Machine::usable(spec.stack));
  thread.events_ = 0;
  thread.wanted_ = 0;
  thread.activations_ = 0;
  thread.run_time_ = 0;
  thread.missed_ = 0;
  machine_.prepare(thread.context_, spec, thread.stack());

  port::Lock lock(machine_);
  const auto begin = by_rank_.begin();
  const auto place = std::find_if(begin, begin + count_, [&](const Thread* other) {
    return standing(*other) < standing(thread);
  });
  const auto rank = static_cast<unsigned>(place - begin);
  std::move_backward(place, begin + count_, begin + count_ + 1);
  *place = &thread;
  ++count_;
  ready_.open_place(rank);
  shift_ranks(rank);
  thread.state_ = Thread::State::ready;
  make_ready(thread);
  return true;
}

void Kernel::remove(Thread& thread) {
  port::Lock lock(machine_);
  if (thread.state_ == Thread::State::absent) return;
  make_unready(thread);
  if (stop_watcher_ == &thread) stop_watcher_ = nullptr;
  const unsigned rank = thread.rank_;
  const auto place = by_rank_.begin() + rank;
  std::move(place + 1, by_rank_.begin() + count_, place);
  --count_;
  by_rank_[count_] = &idle_;
  ready_.close_place(rank);
  shift_ranks(rank);
  thread.state_ = Thread::State::absent;
}

void Kernel::shift_ranks(unsigned from) {
  for (unsigned rank = from; rank < count_; ++rank)
    by_rank_[rank]->set_rank(rank, ready_);
  if (running_rank_ != kNoneRuns) running_rank_ = running_->rank_;
}

void Kernel::set_priority(Thread& thread, Priority priority) {
  const bool rises = priority > thread.priority_;
  thread.priority_ = priority;
  if (thread.state_ == Thread::State::absent) return;
  const std::int32_t mine = standing(thread);
  unsigned rank = thread.rank_;
  if (rises) {
    while (rank > 0 && standing(*by_rank_[rank - 1]) < mine)
      swap_with_next(--rank);
  } else {
    while (rank + 1 < count_ && standing(*by_rank_[rank + 1]) >= mine)
      swap_with_next(rank++);
  }
}

// The threads at `rank` and below it change places, and their bits with them. Only if the lower one
// is ready and the upper one runs does another thread have to run.
void Kernel::swap_with_next(unsigned rank) {
  port::Lock lock(machine_);
  Thread& sinks = *by_rank_[rank];
  Thread& rises = *by_rank_[rank + 1];
  const bool rising_ready = ReadySet::contains(rises.ready_place_);
  if (ReadySet::contains(sinks.ready_place_) != rising_ready) {
    ReadySet::toggle(sinks.ready_place_);
    ReadySet::toggle(rises.ready_place_);
  }
  const ReadySet::Place upper = sinks.ready_place_;
  sinks.ready_place_ = rises.ready_place_;
  rises.ready_place_ = upper;
  sinks.rank_ = static_cast<std::uint8_t>(rank + 1);
  rises.rank_ = static_cast<std::uint8_t>(rank);
  by_rank_[rank] = &rises;
  by_rank_[rank + 1] = &sinks;
  if (running_rank_ == rank + 1) {
    running_rank_ = rises.rank_;
  } else if (running_rank_ == rank) {
    running_rank_ = sinks.rank_;
    if (rising_ready) machine_.request_switch();
  }
}

void Kernel::watch_stops(Thread& watcher, Events events) {
  port::Lock lock(machine_);
  stop_watcher_ = &watcher;
  stop_events_ = events;
}

Thread::State Kernel::state(const Thread& thread) const {
  if (thread.state_ != Thread::State::ready) return thread.state_;
  return ReadySet::contains(thread.ready_place_) ? Thread::State::ready : Thread::State::blocked;
}

std::uint32_t Kernel::ticks_to_next_wake() const {
  if (timers_.empty()) return 0;
  return timers_.next_work() - static_cast<std::uint32_t>(ticks_);
}

std::size_t Thread::stack_used() const {
  const auto all = stack();
  const auto first_used =
      std::find_if(all.begin(), all.end(), [](std::byte b) { return b != kPaint; });
  return static_cast<std::size_t>(all.end() - first_used);
}

void Thread::set_stack(std::span<std::byte> stack) {
  stack_ = stack.data();
  stack_bytes_ = static_cast<std::uint16_t>(stack.size());
  std::ranges::fill(stack, kPaint);
}

Kernel::Kernel() : machine_(*this) {
  idle_.name_ = "idle";
  idle_.set_stack(port::Machine::prepare_idle(idle_.context_));
  by_rank_.fill(&idle_);
}

}  // namespace robosync::kernel
