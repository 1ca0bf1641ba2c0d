#include "runtime-m4/port/host/machine.hpp"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <mutex>

#include "runtime-m4/kernel/kernel.hpp"

#if defined(ROBOSYNC_SANITIZE)
#include <sanitizer/asan_interface.h>
#endif

namespace robosync::port {

namespace {

constexpr std::size_t kStackBytes = std::size_t{128} * 1024;

// Stacks that no fiber uses. A plain array, because contexts in static storage are destroyed after most other objects.
constexpr std::size_t kMaxSpareStacks = 128;
constinit std::array<std::byte*, kMaxSpareStacks> spare_stacks{};
constinit std::size_t spare_stack_count = 0;
constinit std::mutex spare_stacks_lock;

FiberStack take_stack() {
  {
    const std::lock_guard lock(spare_stacks_lock);
    if (spare_stack_count > 0) return FiberStack(spare_stacks[--spare_stack_count]);
  }
  return FiberStack(new std::byte[kStackBytes]);
}

// The machine that is switching: makecontext cannot pass it to a new fiber.
thread_local Machine* switching = nullptr;

// Avoids swapcontext(), which makes a system call to save the signal mask, and longjmp(), which makes AddressSanitizer
// unpoison the stack that is left. The builtins: gcc's manual, "Nonlocal gotos".
[[gnu::noinline, gnu::no_sanitize_address]] void go_on_with(Context& to) {
  if (to.has_run) __builtin_longjmp(to.registers.data(), 1);
  to.has_run = true;
  setcontext(&to.begin);
}

// Returns when a switch continues `from`.
[[gnu::noinline, gnu::no_sanitize_address]] void exchange(Context& from, Context& to) {
  from.has_run = true;
  if (__builtin_setjmp(from.registers.data()) == 0) go_on_with(to);
}

// Tells AddressSanitizer that the program moves to the stack of `to`. A null `keep` abandons the stack
// that it leaves.
void announce_switch([[maybe_unused]] void** keep, [[maybe_unused]] const Context& to) {
#if defined(ROBOSYNC_SANITIZE)
  __sanitizer_start_switch_fiber(keep, to.stack_bottom, to.stack_bytes);
#endif
}

// Tells it that a stack is empty: frames that never returned are still marked there.
void announce_empty([[maybe_unused]] const Context& context) {
#if defined(ROBOSYNC_SANITIZE)
  __asan_unpoison_memory_region(context.stack_bottom, context.stack_bytes);
#endif
}

// Tells it that the program has arrived. `kept` is what announce_switch kept when this stack was left,
// null on its first run. Stores the bounds of the stack that it came from.
void announce_arrival([[maybe_unused]] void* kept, [[maybe_unused]] Context& came_from) {
#if defined(ROBOSYNC_SANITIZE)
  __sanitizer_finish_switch_fiber(kept, &came_from.stack_bottom, &came_from.stack_bytes);
#endif
}

}  // namespace

void ReturnStack::operator()(std::byte* stack) const noexcept {
  {
    const std::lock_guard lock(spare_stacks_lock);
    if (spare_stack_count < kMaxSpareStacks) {
      spare_stacks[spare_stack_count++] = stack;
      return;
    }
  }
  delete[] stack;
}

void Machine::prepare(Context& context, const kernel::ThreadSpec& spec, std::span<std::byte>) {
  if (context.stack == nullptr) context.stack = take_stack();
  context.entry = spec.entry;
  context.argument = spec.argument;
  context.sanitizer_stack = nullptr;
  context.stack_bottom = context.stack.get();
  context.stack_bytes = kStackBytes;
  announce_empty(context);
  context.has_run = false;
  getcontext(&context.begin);
  context.begin.uc_stack.ss_sp = context.stack.get();
  context.begin.uc_stack.ss_size = kStackBytes;
  context.begin.uc_link = nullptr;
  makecontext(&context.begin, &Machine::fiber_main, 0);
}

std::span<std::byte> Machine::usable(const kernel::ThreadSpec& spec) {
  return spec.stack.subspan(spec.data_bytes);
}

std::uint32_t call(kernel::Kernel& kernel, std::uint32_t number, std::uint32_t argument) {
  while (true) {
    CallFrame call(number, argument);
    {
      const auto lock = kernel.lock_interrupts();
      kernel.answer(call);
    }  // it blocks here
    if (!call.repeats()) return call.result();
  }
}

void panic(const char* service, const char* why) {
  std::fprintf(stderr, "kernel: %s() was called %s\n", service, why);
  std::abort();
}

void stop_overrun(kernel::Kernel& kernel, kernel::Thread& thread) {
  kernel.stop(thread);
}

void Machine::fiber_main() {
  switching->enter_fiber();
}

void Machine::enter_fiber() {
  announce_arrival(nullptr, *from_);
  kernel::Thread& self = kernel_.current();
  const Context& context = kernel::Kernel::context(self);
  context.entry(context.argument);
  kernel_.stop(self);  // switches away for good
}

// Switches to the highest ready thread; returns when the calling thread (or idle) runs again.
void Machine::switch_now() {
  switch_requested_ = false;
  kernel::Thread& left = kernel_.current();
  kernel::Thread& next = kernel_.select_next();
  if (&next == &left) return;
  on_fiber_ = &next != &kernel_.idle();
  const bool for_good = kernel_.state(left) == kernel::Thread::State::stopped;
  Context& from = kernel::Kernel::context(left);
  Context& to = kernel::Kernel::context(next);
  from_ = &from;
  switching = this;
  announce_switch(for_good ? nullptr : &from.sanitizer_stack, to);
  exchange(from, to);
  announce_arrival(from.sanitizer_stack, *from_);
}

void Machine::run() {
  run_until(kernel::kForever);
}

void Machine::run_until(kernel::Time until) {
  stop_requested_ = false;
  while (true) {
    switch_now();
    if (stop_requested_) return;
    const std::uint32_t ticks = kernel_.ticks_to_next_wake();
    if (ticks == 0 || kernel_.now() + ticks * kernel::kTick > until) break;
    kernel_.on_tick(ticks);
  }
  if (until == kernel::kForever) return;
  while (until >= kernel_.now() + kernel::kTick) {
    const kernel::Time ticks = (until - kernel_.now()) / kernel::kTick;
    kernel_.on_tick(
        static_cast<std::uint32_t>(std::min<kernel::Time>(ticks, kernel::TimerQueue::kMaxTicks)));
  }
}

}  // namespace robosync::port
