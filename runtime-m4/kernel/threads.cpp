// Adding and removing threads. Bounded: a thread moves by at most kMaxThreads ranks. Built for size;
// the time-critical services are in kernel.cpp.
#include <algorithm>

#include "runtime-m4/kernel/kernel.hpp"

namespace robosync::kernel {

bool Kernel::add(Thread& thread, const ThreadSpec& spec) {
  expect().no_handler();
  if (thread.state_ != Thread::State::absent || count_ == kMaxThreads) return false;
  if (spec.entry == nullptr || spec.stack.size() < port::kMinStack) return false;
  const auto priority = static_cast<std::int8_t>(spec.priority);
  if (spec.stack.size() > 0xFFFF || priority != spec.priority) return false;
  if (!port::Machine::can_run(spec)) return false;
  thread.name_ = spec.name;
  thread.set_stack(port::Machine::usable(spec));
  thread.events_ = 0;
  thread.wanted_ = 0;
  thread.activations_ = 0;
  thread.missed_ = 0;
  machine_.prepare(thread, spec, thread.stack());

  port::SwitchLock still(machine_);  // one change of the order at a time
  {
    port::Lock lock(machine_);
    thread.set_standing(standing(spec.category, priority));
  }
  enter(thread);
  rise(thread);
  port::Lock lock(machine_);
  thread.state_ = Thread::State::ready;
  make_ready(thread);
  return true;
}

void Kernel::remove(Thread& thread) {
  expect().no_handler();
  expect().that(&thread != running_, "of the running thread");
  port::SwitchLock still(machine_);
  if (thread.state_ == Thread::State::absent) return;
  {
    port::Lock lock(machine_);
    make_unready(thread);
    if (watcher_ == &thread) watcher_ = nullptr;
  }
  sink_below(thread, kBelowAll);
  leave(thread);
  port::Lock lock(machine_);
  thread.state_ = Thread::State::absent;
}

void Kernel::watch(Thread& watcher, Events stops, Events reports) {
  expect().no_handler();
  port::Lock lock(machine_);
  watcher_ = &watcher;
  stop_events_ = stops;
  report_events_ = reports;
}

void Kernel::grant(const port::Areas& areas) {
  expect().no_handler();
  port::Lock lock(machine_);
  port::Machine::grant(areas);
}

Thread::State Kernel::state(const Thread& thread) const {
  if (thread.state_ != Thread::State::ready) return thread.state_;
  return ReadySet::contains(thread.ready_position_) ? Thread::State::ready : Thread::State::blocked;
}

std::uint32_t Kernel::run_time(const Thread& thread) const {
  expect().any();
  port::Lock lock(machine_);
  return port::Machine::run_time(thread, run_clock_, &thread == running_);
}

std::uint32_t Kernel::ticks_to_next_wake() const {
  if (timers_.empty()) return 0;
  return ticks_to_next_work();
}

void Kernel::begin_era(std::uint32_t tick) {
  port::OnlyLock lock(machine_);
  tick_ = tick;
  ++eras_;
}

std::size_t Thread::stack_used() const {
  const auto all = stack();
  std::size_t never = 0;  // std::find_if is four times as large
  while (never < all.size() && all[never] == kPaint)
    ++never;
  return all.size() - never;
}

void Thread::set_stack(std::span<std::byte> stack) {
  stack_ = stack.data();
  stack_bytes_ = static_cast<std::uint16_t>(stack.size());
  std::ranges::fill(stack, kPaint);
}

Kernel::Kernel() : machine_(*this) {
  running_ = &idle_;
  idle_.name_ = "idle";
  idle_.set_stack(port::Machine::prepare_idle(context(idle_)));
  by_rank_.fill(&idle_);
  highest_of_.fill(kIdleRank);
}

}  // namespace robosync::kernel
