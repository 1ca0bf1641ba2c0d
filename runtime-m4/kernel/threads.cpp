// Which threads there are: creation and removal. Bounded: a change moves at most kMaxThreads places.
// Built for size; what is in a hurry stands in kernel.cpp.
#include <algorithm>

#include "runtime-m4/kernel/kernel.hpp"

namespace robosync::kernel {

bool Kernel::add(Thread& thread, const ThreadSpec& spec) {
  if (thread.state_ != Thread::State::absent || count_ == kMaxThreads) return false;
  if (spec.entry == nullptr || spec.stack.size() < port::kMinStack) return false;
  const auto priority = static_cast<std::int8_t>(spec.priority);
  if (spec.stack.size() > 0xFFFF || priority != spec.priority) return false;
  if (!port::Machine::can_run(spec)) return false;
  thread.name_ = spec.name;
  thread.category_ = spec.category;
  thread.priority_ = {priority, priority};
  thread.set_stack(port::Machine::usable(spec));
  thread.events_ = 0;
  thread.wanted_ = 0;
  thread.activations_ = 0;
  thread.missed_ = 0;
  machine_.prepare(thread, spec, thread.stack());

  port::Lock lock(machine_);
  const auto begin = by_rank_.begin();
  const auto place = std::find_if(begin, begin + count_, [&](const Thread* other) {
    return other->standing() < thread.standing();
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
  if (watcher_ == &thread) watcher_ = nullptr;
  const unsigned rank = thread.rank_;
  const auto place = by_rank_.begin() + rank;
  std::move(place + 1, by_rank_.begin() + count_, place);
  --count_;
  by_rank_[count_] = &idle_;
  ready_.close_place(rank);
  shift_ranks(rank);
  thread.state_ = Thread::State::absent;
}

void Kernel::watch(Thread& watcher, Events stops, Events reports) {
  port::Lock lock(machine_);
  watcher_ = &watcher;
  stop_events_ = stops;
  report_events_ = reports;
}

void Kernel::open(const port::Areas& areas) {
  port::Lock lock(machine_);
  port::Machine::open(areas);
}

Thread::State Kernel::state(const Thread& thread) const {
  if (thread.state_ != Thread::State::ready) return thread.state_;
  return ReadySet::contains(thread.ready_place_) ? Thread::State::ready : Thread::State::blocked;
}

std::uint32_t Kernel::run_time(const Thread& thread) const {
  port::Lock lock(machine_);
  return port::Machine::run_time(thread, &thread == running_);
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
  idle_.set_stack(port::Machine::prepare_idle(context(idle_)));
  by_rank_.fill(&idle_);
  highest_of_.fill(kIdleRank);
}

}  // namespace robosync::kernel
