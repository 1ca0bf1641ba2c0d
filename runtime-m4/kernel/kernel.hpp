// The kernel's services: threads, event bits, time, mutexes. Preemptive, fixed priority, one rank
// per thread.
//
// Legal context of each function: [thread] from a running thread, [any] from a thread or an
// interrupt handler, [init] before run(). Builds for tests assert it (assertions.hpp). Nothing here
// allocates; threads and their stacks belong to the caller. Policy: scheduler.hpp. Time:
// timer_queue.hpp. Context switch: port/cortex-m4/switch.S. Read docs/kernel.md first.
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

// What the context switch reads. switch.S loads it in one go and relies on this layout; machine.cpp
// asserts the offsets.
struct Selection {
  Thread* running_ = nullptr;
  [[no_unique_address]] port::RunClock run_clock_;
  Mutex* held_ = nullptr;  // the latest of the held mutexes
  ReadySet ready_;
  // The ceiling if the running thread holds a mutex, else its rank; Kernel::kNoneRuns from the moment
  // it blocks.
  std::uint8_t running_rank_ = kIdleRank;
  std::uint8_t ceiling_ = kIdleRank;  // the highest ceiling of the held mutexes
  std::uint8_t count_ = 0;
  std::array<Thread*, kMaxThreads + 1> by_rank_{};  // the last is idle
};

class Kernel : private Selection {
public:
  Kernel();
  Kernel(const Kernel&) = delete;
  Kernel& operator=(const Kernel&) = delete;

  // Adds a thread, which is ready immediately. The Thread and its stack must outlive it. Hold lock()
  // to add several threads before any of them runs. Returns false and changes nothing if there are
  // kMaxThreads threads, the thread has been added already, or the spec is invalid: no entry, a
  // priority out of range, or a stack of the wrong size or alignment.  [init, thread]
  [[nodiscard]] bool add(Thread& thread, const ThreadSpec& spec);
  // Removes a thread, in any state; it may be added again. Not the calling thread.  [init, thread]
  void remove(Thread& thread);

  // Runs the threads. Returns only on the host, when all threads are blocked without a deadline.
  // [init]
  void run() {
    expect().init();
    machine_.run();
  }

  Time now() const;  // [any]
  // Like now(), but only under lock(). Two 32-bit multiplications: one of 64 bits takes three times
  // as long.
  Time time() const {
    constexpr auto kTickLength = static_cast<std::uint32_t>(kTick);
    const std::uint32_t upper = eras_ * kTickLength;
    return Time{tick_} * kTickLength + (Time{upper} << 32U);
  }
  // Ticks since start-up, modulo 2^32: for differences.  [any]
  std::uint32_t tick() const { return tick_; }
  // The running thread, or the one that an interrupt preempted.  [any]
  Thread& current() { return *running_; }

  // Blocks until an event of `mask` is signalled or `deadline` is reached. Takes the signalled events
  // of `mask` and returns them; 0 after the deadline. With a deadline in the past it never blocks.
  // [thread]
  Events wait(Events mask, Time deadline = kForever) {
    expect_may_block();
    return deadline == kForever ? wait_for(mask) : wait_until(mask, deadline);
  }
  // Blocks until `deadline`; events signalled meanwhile are kept.  [thread]
  void sleep_until(Time deadline) {
    expect_may_block();
    wait_until(0, deadline);
  }
  // Signals events of a thread, and makes it ready if it waits for one of them.  [any]
  void signal(Thread& thread, Events events);
  // signal() and wait() in one call. A thread that this wakes runs only after the calling thread has
  // blocked, unless an event of `mask` is signalled already.  [thread]
  Events signal_and_wait(Thread& thread, Events events, Events mask, Time deadline);
  // Changes a thread's priority. It moves to the rank it would get if it were added now: behind its
  // equals. Neighbours are exchanged pair by pair, each under its own lock, so the time for which
  // interrupts are held off does not depend on how far the thread moves. One caller at a time, and
  // not during add() or remove().  [init, thread]
  void set_priority(Thread& thread, Priority priority);
  // Stops a thread (it faulted, or its entry returned); it does not run again until it is removed and
  // added. A handler may stop only the running thread, and only if that holds no SwitchLock: a change
  // of the timers might be half done.  [thread; handlers of a thread's own faults and calls]
  [[gnu::cold]] void stop(Thread& thread);
  // From now on, signals `stops` to `watcher` whenever a thread is stopped, and `reports` whenever an
  // unprivileged thread makes the system call `report`.  [init, thread]
  void watch(Thread& watcher, Events stops, Events reports);

  // From now on, unprivileged threads may also access `areas`, besides their own stacks. The host does
  // not restrict access.  [init, thread]
  void grant(const port::Areas& areas);

  // While it is held, no other thread runs and the tick does not advance; interrupts are still taken.
  // Hold it for a few hundred instructions at most; blocking under it is an error.  [any]
  [[nodiscard]] port::SwitchLock lock() {
    expect().any();
    return port::SwitchLock(machine_);
  }
  // Like lock(), but also holds off interrupts of the kernel's level: for data that interrupts
  // change. Hold it for a few instructions.  [any]
  [[nodiscard]] port::Lock lock_interrupts() {
    expect().any();
    return port::Lock(machine_);
  }

  // Takes a mutex, which never blocks, and releases it (mutex.hpp; MutexGuard does both).  [thread]
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

  // All threads, by rank.  [any; the span is valid until threads are added or removed]
  std::span<Thread* const> threads() const { return {by_rank_.data(), count_}; }
  Thread::State state(const Thread& thread) const;  // [any]
  // Is that State::ready? Only of a thread that has been added, and not removed.  [any]
  [[nodiscard]] bool is_ready(const Thread& thread) const {
    return ReadySet::contains(thread.ready_position_);
  }

  // A free-running counter of the processor's clock; wraps.  [any]
  std::uint32_t clock() const { return 0 - port::Machine::clock(); }
  // Counts of clock() for which a thread has run since it was added, including interrupts during that
  // time; wraps. Always 0 if port::kTimeFlows is false.  [any]
  std::uint32_t run_time(const Thread& thread) const;

  // --- for the port ---

  // For the tick interrupt: `ticks` ticks have passed (possibly 0); wakes the threads that are due.
  // Only interrupts of the kernel's level and above preempt it, and it preempts no switch.
  void on_tick(std::uint32_t ticks) {
    expect().no_thread();
    pass(ticks);
    if (timers_.has_work(tick_)) wake_due();
  }
  // Like on_tick(), but wakes no thread: on_tick() must follow before a thread runs. Usually one word
  // changes, so an interrupt that reads the time finds it consistent; begin_era() changes two, under
  // a lock.
  void pass(std::uint32_t ticks) {
    const std::uint32_t next = tick_ + ticks;
    if (next < ticks) [[unlikely]]
      return begin_era(next);
    tick_ = next;
  }
  // Ticks until on_tick() may have to wake a thread, at least 1; 0 when no thread sleeps.
  std::uint32_t ticks_to_next_wake() const;
  // Like ticks_to_next_wake(), but in constant time: not 0 when no thread sleeps.
  std::uint32_t ticks_to_next_work() const { return timers_.next_work() - tick_; }

  // For the context switch: makes the highest ready thread the running one, unless the holder of a
  // mutex has at least that rank by its ceiling. Interrupts may come in between: after `ready_` is
  // read, they compare with a running_rank_ that is not above the one found, so no thread that they
  // make ready is overlooked. (The Cortex-M4 does the same in registers: switch.S.)
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

  // Handles a system call of an unprivileged thread (calls.def).
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
  static constexpr std::uint8_t kNoneRuns = 0xFF;  // below every rank: any wake-up switches

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
  void report();
  void rest(Events mask);
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
  void swap_ranks(Thread& sinks, Thread& rises);
  void move_highest(const Thread& sunk, const Thread& risen);

  std::array<std::uint8_t, kCategories> highest_of_;  // rank of the highest thread of each category
  std::uint32_t tick_ = 0;                            // wraps
  std::uint32_t eras_ = 0;                            // how often tick_ has wrapped
  TimerQueue timers_;
  Thread* watcher_ = nullptr;
  Events stop_events_ = 0;
  Events report_events_ = 0;
  Thread idle_;
  [[no_unique_address]] port::Machine machine_;
};

// Called with interrupts held off. A woken thread takes its events by making the call again.
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
