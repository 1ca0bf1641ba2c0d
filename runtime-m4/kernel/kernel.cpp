// Waiting, waking and time: the time-critical paths. bench/ counts their instructions.
//
// A thread's bit in the ready set and its events change under a Lock only, so that interrupts see
// them consistent; the one exception is Thread::take(), which is atomic. Interrupts do not use the
// timers. The tick changes the queue, and only interrupts can preempt it; threads change the queue
// under a SwitchLock, which does not hold interrupts off. So a Lock is held for a few instructions
// only. Every path is bounded: the longest is wake_due() when all threads are due at one tick.
#include "runtime-m4/kernel/kernel.hpp"

#include <algorithm>

namespace robosync::kernel {

namespace {

// In microseconds, with room to round up to a tick. A longer wait sleeps several times.
constexpr std::uint32_t kLongestSleep = UINT32_MAX - static_cast<std::uint32_t>(kTick);

}  // namespace

Time Kernel::now() const {
  expect().any();
  port::SwitchLock still(machine_);
  return time();
}

Events Kernel::wait_for(Events mask) {
  Thread& self = *running_;
  if (self.armed()) [[unlikely]]
    disarm(self);
  {
    port::Lock lock(machine_);
    if ((self.events_ & mask) == 0) block(self, mask);
  }  // the switch happens here, and the woken thread continues here
  const Events taken = self.take(mask);
  // Only an event wakes the thread, so this is for a machine that switches late.
  if (taken == 0) [[unlikely]]
    return wait_until(mask, kForever);
  return taken;
}

// True if the deadline is reached once the timer is no longer armed: the timer covers all of the
// remaining time, or is not armed because the deadline has passed. The SwitchLock keeps the tick out
// between arming and blocking; a tick there would make the thread ready before it blocks, and the
// thread would then block for ever. The check under the Lock sees an interrupt that signals in between.
inline bool Kernel::block_until(Thread& thread, Events mask, Time deadline) {
  port::SwitchLock still(machine_);
  if (thread.armed()) TimerQueue::disarm(thread);
  const Time present = time();
  if (deadline <= present) return true;
  const Duration sleep = std::min<Duration>(deadline - present, kLongestSleep);
  arm(thread, static_cast<std::uint32_t>(sleep));
  port::Lock lock(machine_);
  if ((thread.events_ & mask) == 0) block(thread, mask);
  return deadline - present <= kLongestSleep;
}

// The timer of a thread that an event has woken stays armed until the thread waits again, so that
// cancelling it does not delay the response to the event. It is harmless meanwhile: if it expires, it
// makes this thread ready, which it is already.
Events Kernel::wait_until(Events mask, Time deadline) {
  Thread& self = *running_;
  while (true) {
    const bool there = (self.events_ & mask) != 0;
    const bool last = !there && block_until(self, mask, deadline);
    const Events taken = self.take(mask);
    if (taken != 0) return taken;
    if (last && !self.armed()) return 0;
  }
}

Events Kernel::signal_and_wait(Thread& thread, Events events, Events mask, Time deadline) {
  expect_may_block();
  {
    port::SwitchLock still(machine_);
    signal(thread, events);
    if ((running_->events_ & mask) == 0) block_until(*running_, mask, deadline);
  }
  return wait_until(mask, deadline);
}

void Kernel::disarm(Thread& thread) {
  port::SwitchLock still(machine_);
  if (thread.armed()) TimerQueue::disarm(thread);
}

// `sleep` is in microseconds, rounded up to a tick. Under a SwitchLock.
void Kernel::arm(Thread& thread, std::uint32_t sleep) {
  constexpr auto kTickLength = static_cast<std::uint32_t>(kTick);
  const std::uint32_t ticks = (sleep + kTickLength - 1) / kTickLength;
  timers_.arm(thread, tick_ + ticks, tick_);
}

void Kernel::block(Thread& thread, Events mask) {
  expect().locked();
  thread.wanted_ = mask;
  ++thread.activations_;
  ReadySet::erase(thread.ready_position_);
  running_rank_ = kNoneRuns;
  machine_.request_switch();
}

// The switch waits for the end of the Lock. Requesting it first leaves the compiler enough registers.
void Kernel::make_ready(Thread& thread) {
  expect().locked();
  if (thread.rank_ < running_rank_) [[likely]]
    machine_.request_switch();
  ReadySet::insert(thread.ready_position_);
}

// Under a Lock, so that no tick is in progress.
void Kernel::make_unready(Thread& thread) {
  if (thread.armed()) TimerQueue::disarm(thread);
  release_all(thread);
  thread.wanted_ = 0;
  ReadySet::erase(thread.ready_position_);
}

void Kernel::signal(Thread& thread, Events events) {
  expect().any();
  port::Lock lock(machine_);
  const Events all = thread.events_ | events;
  thread.events_ = all;
  if ((all & thread.wanted_) == 0) return;
  make_ready(thread);
}

void Kernel::stop(Thread& thread) {
  expect_may_stop(thread);
  port::Lock lock(machine_);
  if (thread.state_ != Thread::State::ready) return;
  make_unready(thread);
  thread.state_ = Thread::State::stopped;
  if (&thread == running_) {
    running_rank_ = kNoneRuns;
    machine_.request_switch();
  }
  if (watcher_ != nullptr) signal(*watcher_, stop_events_);
}

void Kernel::report() {
  if (watcher_ != nullptr) signal(*watcher_, report_events_);
}

// Called with interrupts held off.
void Kernel::rest(Events mask) {
  running_->events_ &= ~mask;
  report();
  block(*running_, mask);
}

void Kernel::wake_due() {
  do {
    Timer* due = timers_.collect();
    while (due != nullptr) {
      auto& thread = static_cast<Thread&>(TimerQueue::take_first(due));
      port::OnlyLock lock(machine_);  // one per thread, so that interrupts are taken in between
      make_ready(thread);
    }
  } while (timers_.has_work(tick_));
}

}  // namespace robosync::kernel
