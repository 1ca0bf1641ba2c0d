// The kernel's services: threads, event bits, time. Preemptive, fixed priority, one rank per
// thread.
//
// Legal context of each function: [thread] from a running thread, [any] from a thread or an
// interrupt handler, [init] before run(). Nothing here allocates; threads and their stacks belong
// to the caller. Policy: scheduler.hpp. Time: timer_queue.hpp. Context switch:
// port/cortex-m4/switch.S. Read docs/kernel.md first.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>

#include "runtime-m4/kernel/scheduler.hpp"
#include "runtime-m4/kernel/thread.hpp"
#include "runtime-m4/kernel/time.hpp"
#include "runtime-m4/kernel/timer_queue.hpp"
#include "runtime-m4/port/port.hpp"

namespace robosync::kernel {

class Kernel {
public:
  Kernel();
  Kernel(const Kernel&) = delete;
  Kernel& operator=(const Kernel&) = delete;

  // Adds a thread; it is ready at once. The Thread and its stack must outlive it. To let none of a
  // batch run before all are there, hold lock(). False, and nothing changed, when kMaxThreads are
  // there, the thread is already in, or the spec has no entry or too small a stack.  [init, thread]
  [[nodiscard]] bool add(Thread& thread, const ThreadSpec& spec);
  // Takes a thread out, whatever it waits for; it may be added again. Not the calling thread.
  // [init, thread]
  void remove(Thread& thread);

  // Runs the threads. Returns only on the host, when nothing is left to happen.  [init]
  void run() { machine_.run(); }

  Time now() const;                        // [any]
  Thread& current() { return *running_; }  // [thread]

  // Blocks until one of `mask` is signalled or `deadline` is reached. Returns the events that were
  // there, and clears them; 0 after the deadline. A deadline in the past only looks.  [thread]
  Events wait(Events mask, Time deadline = kForever) {
    return deadline == kForever ? wait_for(mask) : wait_until(mask, deadline);
  }
  // Blocks until `deadline`; events signalled meanwhile are kept.  [thread]
  void sleep_until(Time deadline) { wait_until(0, deadline); }
  // Sets events of a thread and lets it run if it waits for one of them.  [any]
  void signal(Thread& thread, Events events);
  // Gives a thread another priority: its place is then the one it would have if it were added now,
  // behind its equals. The order changes by pairs of neighbours, each under a lock of its own, so
  // nothing is held off for longer however far the thread moves. One caller at a time, and not
  // during add() or remove().  [init, thread]
  void set_priority(Thread& thread, Priority priority);
  // Stops a thread for good (fault, or its entry returned); it is never run again.  [any]
  void stop(Thread& thread);
  // From now on `events` of `watcher` are signalled whenever a thread is stopped.  [init, thread]
  void watch_stops(Thread& watcher, Events events);

  // While it is held no other thread runs and no interrupt of the kernel's level is taken. Hold it
  // for a few hundred instructions at most; blocking under it is an error.  [any]
  [[nodiscard]] port::Lock lock() { return port::Lock(machine_); }

  // All threads, by rank.  [any; the span is good until threads are added or removed]
  std::span<Thread* const> threads() const { return {by_rank_.data(), count_}; }
  Thread::State state(const Thread& thread) const;  // [any]

  // What Thread::run_time() counts in; wraps.  [any]
  std::uint32_t clock() const { return 0 - port::Machine::clock(); }

  // --- for the port ---

  // The tick interrupt: `elapsed` ticks have passed, none of them beyond next_wake().
  void on_tick(std::uint32_t elapsed = 1) {
    ticks_ += elapsed;
    if (timers_.has_work(static_cast<std::uint32_t>(ticks_))) wake_due();
  }
  // Ticks until on_tick() may have to wake a thread, at least 1; 0 when no thread sleeps.
  std::uint32_t ticks_to_next_wake() const;

  // The context switch: takes the highest ready thread as the running one. Interrupts may come in
  // between: after `ready_` is read they compare with a rank that is not above the one found, so
  // none they make ready is overlooked.
  Thread& select_next() {
    charge();
    const unsigned rank = ready_.first();
    std::atomic_signal_fence(std::memory_order_seq_cst);
    running_rank_ = static_cast<std::uint8_t>(rank);
    running_ = by_rank_[rank];
    return *running_;
  }

  Thread& idle() { return idle_; }
  port::Machine& machine() { return machine_; }
  static port::Context& context(Thread& thread) { return thread.context_; }

private:
  static constexpr std::uint8_t kNoneRuns = 0xFF;  // ranks below everything: any wake-up switches

  Events wait_for(Events mask);
  Events wait_until(Events mask, Time deadline);
  bool arm(Thread& thread, Time deadline);
  void disarm(Thread& thread);
  void block(Thread& thread, Events mask);
  void make_ready(Thread& thread);
  void make_unready(Thread& thread);
  void wake_due();
  // The thread that ran until now has run since the last switch, interrupts meanwhile included.
  void charge() {
    if (!port::kTimeFlows) return;
    const std::uint32_t now = port::Machine::clock();
    running_->run_time_ += switched_at_ - now;
    switched_at_ = now;
  }
  void shift_ranks(unsigned from);
  void swap_with_next(unsigned rank);

  std::array<Thread*, kMaxThreads + 1> by_rank_{};  // the last is idle_
  ReadySet ready_;
  Thread* running_ = &idle_;
  std::uint8_t running_rank_ = kIdleRank;  // kNoneRuns from the moment the running thread blocks
  std::uint8_t count_ = 0;
  std::uint64_t ticks_ = 0;
  std::uint32_t switched_at_ = 0;  // the machine's clock at the last switch
  TimerQueue timers_;
  Thread* stop_watcher_ = nullptr;
  Events stop_events_ = 0;
  Thread idle_;
  [[no_unique_address]] port::Machine machine_;
};

}  // namespace robosync::kernel
