// The kernel's services: threads, event bits, time, mutexes. Preemptive, fixed priority, one rank
// per thread.
//
// Legal context of each function: [thread] from a running thread, [any] from a thread or an
// interrupt handler, [init] before run(). Builds for tests assert it (assertions.hpp). Nothing here
// allocates; threads and their stacks belong to the caller. Policy: scheduler.hpp. Time: timer_queue.hpp. Context switch:
// port/cortex-m4/switch.S. Read docs/kernel.md first.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>

#include "runtime-m4/kernel/assertions.hpp"
#include "runtime-m4/kernel/mutex.hpp"
#include "runtime-m4/kernel/scheduler.hpp"
#include "runtime-m4/kernel/thread.hpp"
#include "runtime-m4/kernel/time.hpp"
#include "runtime-m4/kernel/timer_queue.hpp"
#include "runtime-m4/port/port.hpp"

namespace robosync::kernel {

enum class Call : std::uint32_t {
#define CALL(name, number, doc) name = (number),
#include "runtime-m4/kernel/calls.def"
#undef CALL
};

// What the context switch goes by. The Cortex-M4's reads it at once, so switch.S knows where what stands
// (machine.cpp holds it to that).
struct Selection {
  Thread* running_ = nullptr;
  [[no_unique_address]] port::RunClock run_clock_;
  Mutex* held_ = nullptr;  // the latest of those that are held
  ReadySet ready_;
  // The ceiling of what the running thread holds, else its rank; Kernel's kNoneRuns from the moment
  // it blocks.
  std::uint8_t running_rank_ = kIdleRank;
  std::uint8_t ceiling_ = kIdleRank;  // the highest of the ceilings of what is held
  std::uint8_t count_ = 0;
  std::array<Thread*, kMaxThreads + 1> by_rank_{};  // the last is idle
};

class Kernel : private Selection {
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
  void run() {
    expect().init();
    machine_.run();
  }

  Time now() const;  // [any]
  // The same under lock(). In two multiplications, where one of 64 bits takes three times as long.
  Time time() const {
    constexpr auto kTickLength = static_cast<std::uint32_t>(kTick);
    const std::uint32_t upper = eras_ * kTickLength;
    return Time{tick_} * kTickLength + (Time{upper} << 32U);
  }
  // The ticks of it, of which the upper ones are lost: for differences.  [any]
  std::uint32_t tick() const { return tick_; }
  // Who runs, or was interrupted.  [any]
  Thread& current() { return *running_; }

  // Blocks until one of `mask` is signalled or `deadline` is reached. Returns the events that were
  // there, and clears them; 0 after the deadline. A deadline in the past only looks.  [thread]
  Events wait(Events mask, Time deadline = kForever) {
    expect_may_block();
    return deadline == kForever ? wait_for(mask) : wait_until(mask, deadline);
  }
  // Blocks until `deadline`; events signalled meanwhile are kept.  [thread]
  void sleep_until(Time deadline) {
    expect_may_block();
    wait_until(0, deadline);
  }
  // Sets events of a thread and lets it run if it waits for one of them.  [any]
  void signal(Thread& thread, Events events);
  // The same, and waits: whoever that lets run finds this thread blocked, unless one of `mask` is there.  [thread]
  Events signal_and_wait(Thread& thread, Events events, Events mask, Time deadline);
  // Gives a thread another priority: its place is then the one it would have if it were added now,
  // behind its equals. The order changes by pairs of neighbours, each under a lock of its own, so
  // nothing is held off for longer however far the thread moves. One caller at a time, and not
  // during add() or remove().  [init, thread]
  void set_priority(Thread& thread, Priority priority);
  // Stops a thread for good (fault, or its entry returned); it is never run again. From a handler
  // only the running thread, and not one that holds a SwitchLock: the timers would be in the midst
  // of a change.  [thread; handlers of a thread's own faults and calls]
  [[gnu::cold]] void stop(Thread& thread);
  // From now on `stops` of `watcher` are signalled whenever a thread is stopped, and `reports`
  // whenever one without privileges makes the call `report`.  [init, thread]
  void watch(Thread& watcher, Events stops, Events reports);

  // From now on threads without privileges may read and write what `areas` says, besides their own
  // stacks. The host has no such borders.  [init, thread]
  void grant(const port::Areas& areas);

  // While it is held no other thread runs, and time stands still; interrupts come in. Hold it for a
  // few hundred instructions at most; blocking under it is an error.  [any]
  [[nodiscard]] port::SwitchLock lock() {
    expect().any();
    return port::SwitchLock(machine_);
  }
  // The same, and no interrupt of the kernel's level is taken either: for what interrupts change,
  // too. Hold it for a few instructions.  [any]
  [[nodiscard]] port::Lock lock_interrupts() {
    expect().any();
    return port::Lock(machine_);
  }

  // Takes a mutex, without ever waiting for it, and gives it back (mutex.hpp; MutexGuard does
  // both).  [thread]
  [[gnu::always_inline]] void acquire(Mutex& mutex) {
    expect().thread();
    if (held_ != nullptr) [[unlikely]]
      return acquire_another(mutex);
    const port::OnlyLock lock(machine_);
    mutex.owner_ = running_;
    held_ = &mutex;
    ceiling_ = highest_of_[index(mutex.highest_)];
    running_rank_ = ceiling_;
  }
  [[gnu::always_inline]] void release(Mutex& mutex) {
    expect().thread();
    expect().that(mutex.owner_ == running_, "by a thread that does not hold it");
    if (mutex.not_alone_) [[unlikely]]
      return release_one(mutex);
    const port::OnlyLock lock(machine_);
    mutex.owner_ = nullptr;
    held_ = nullptr;
    running_rank_ = running_->rank_;
    if (ready_.first() < running_rank_) [[unlikely]]
      machine_.request_switch();
  }

  // All threads, by rank.  [any; the span is good until threads are added or removed]
  std::span<Thread* const> threads() const { return {by_rank_.data(), count_}; }
  Thread::State state(const Thread& thread) const;  // [any]

  // A free-running counter of the processor's clock; wraps.  [any]
  std::uint32_t clock() const { return 0 - port::Machine::clock(); }
  // Counts of it that a thread ran since it was added, interrupts meanwhile included; wraps. Always
  // 0 where time does not flow.  [any]
  std::uint32_t run_time(const Thread& thread) const;

  // --- for the port ---

  // The tick interrupt: so many ticks have passed, be it none; wakes who is due. Nothing preempts
  // it but interrupts of the kernel's level and above, and it preempts no switch.
  void on_tick(std::uint32_t ticks) {
    expect().no_thread();
    pass(ticks);
    if (timers_.has_work(tick_)) wake_due();
  }
  // The same without waking anybody: on_tick() must follow before a thread runs. One word changes,
  // so that an interrupt which asks for the time finds it right; two change under a lock.
  void pass(std::uint32_t ticks) {
    const std::uint32_t next = tick_ + ticks;
    if (next < ticks) [[unlikely]]
      return begin_era(next);
    tick_ = next;
  }
  // Ticks until on_tick() may have to wake a thread, at least 1; 0 when no thread sleeps.
  std::uint32_t ticks_to_next_wake() const;
  // … whether one sleeps or not: found at once, and perhaps for nothing.
  std::uint32_t ticks_to_next_work() const { return timers_.next_work() - tick_; }

  // The context switch: takes the highest ready thread as the running one, unless the holder of a
  // mutex stands at its ceiling. Interrupts may come in between: after `ready_` is read they
  // compare with a rank that is not above the one found, so none they make ready is overlooked.
  // (The Cortex-M4 does the same in registers: switch.S.)
  Thread& select_next() {
    const unsigned rank = ready_.first();
    std::atomic_signal_fence(std::memory_order_seq_cst);
    if (held_ != nullptr && rank >= ceiling_) [[unlikely]] {
      running_rank_ = ceiling_;
      running_ = held_->owner_;
      return *running_;
    }
    running_rank_ = static_cast<std::uint8_t>(rank);
    running_ = by_rank_[rank];
    return *running_;
  }

  // Does what a thread without privileges asks for: a system call of calls.def.
  void answer(port::CallFrame& call) {
    const auto what = static_cast<Call>(call.number());
    if (what == Call::wait) [[likely]]
      return take_or_block(call);
    if (what == Call::rest) return rest(call.argument());
    if (what == Call::report) return report();
    port::Machine::refuse_call();
  }

  Thread& idle() { return idle_; }
  port::Machine& machine() { return machine_; }
  port::RunClock& run_clock() { return run_clock_; }
  static port::Context& context(Thread& thread) { return thread; }

private:
  static constexpr std::uint8_t kNoneRuns = 0xFF;  // ranks below everything: any wake-up switches

  Expect expect() const { return Expect(machine_); }
  void expect_may_block(const char* service = __builtin_FUNCTION()) const {
    expect().thread(service);
    expect().that(held_ == nullptr || held_->owner_ != running_, "while it holds a mutex", service);
  }

  void expect_may_stop(const Thread& thread, const char* service = __builtin_FUNCTION()) const {
    if constexpr (kAssertions) {
      const bool handler = machine_.mode() == port::Mode::handler;
      expect().that(!handler || &thread == running_, "from a handler, and not the running thread",
                    service);
      expect().that(!handler || machine_.held() == port::Held::none,
                    "of a thread that holds a lock", service);
    }
  }

  Events wait_for(Events mask);
  Events wait_until(Events mask, Time deadline);
  [[gnu::always_inline]] bool block_until(Thread& thread, Events mask, Time deadline);
  void arm(Thread& thread, std::uint32_t sleep);
  [[gnu::cold, gnu::noinline]] void disarm(Thread& thread);
  void block(Thread& thread, Events mask);
  void take_or_block(port::CallFrame& call);
  [[gnu::cold, gnu::noinline]] void report();
  [[gnu::cold]] void rest(Events mask);
  void make_ready(Thread& thread);
  [[gnu::cold]] void make_unready(Thread& thread);
  [[gnu::noinline]] void wake_due();
  [[gnu::cold]] void begin_era(std::uint32_t tick);
  void enter(Thread& thread);
  void leave(const Thread& thread);
  void rise(const Thread& thread);
  void sink_below(const Thread& thread, Standing standing);
  void follow_highest();
  void follow_running();
  static constexpr unsigned index(Category category) { return static_cast<unsigned>(category); }
  [[gnu::cold]] void acquire_another(Mutex& mutex);
  [[gnu::cold]] void release_one(Mutex& mutex);
  [[gnu::cold]] void release_all(const Thread& thread);
  [[gnu::cold]] std::uint8_t find_ceiling() const;
  std::uint8_t rank_of_running() const;
  void swap_with_next(unsigned rank);
  void move_highest(const Thread& sunk, const Thread& risen);

  std::array<std::uint8_t, kCategories> highest_of_;  // rank of the highest thread of each category
  std::uint32_t tick_ = 0;                            // wraps …
  std::uint32_t eras_ = 0;                            // … and so often it did
  TimerQueue timers_;
  Thread* watcher_ = nullptr;
  Events stop_events_ = 0;
  Events report_events_ = 0;
  Thread idle_;
  [[no_unique_address]] port::Machine machine_;
};

// Its interrupts are held off. A thread that was woken takes its events by making the call again.
inline void Kernel::take_or_block(port::CallFrame& call) {
  Thread& self = *running_;
  const Events mask = call.argument();
  const Events taken = self.events_ & mask;
  if (taken == 0) {
    call.repeat();
    return block(self, mask);
  }
  self.events_ &= ~mask;
  call.give(taken);
}

}  // namespace robosync::kernel
