// Hours of virtual time on the board: many threads signal, wait, sleep and take mutexes at random,
// one changes their priorities and its own, and a timer interrupts them after random times, at any
// instruction. Every decision of the context switch, and the running thread at every fourth interrupt, is
// compared with a naive policy that searches all threads; after each change of a priority the
// order is checked. Prints "N decisions compared".
//
// The decision is checked right after the shipped switch: before the switch begins, an interrupt of the same
// level is pended, which is taken before the chosen thread executes anything. For this, the vector table points
// to __wrap_PendSV_Handler, by the linker's --wrap (firmware.cmake). run_stress.sh runs this.
#include <array>
#include <bit>

#include "runtime-m4/boards/common/firmware.hpp"
#include "runtime-m4/boards/mps2-an386/registers.hpp"
#include "runtime-m4/kernel/kernel.hpp"
#include "runtime-m4/port/cortex-m4/core.hpp"
#include "runtime-m4/port/cortex-m4/hooks.hpp"
#include "tests/runtime-m4/kernel/firmware/draw.hpp"
#include "tests/runtime-m4/kernel/firmware/semihosting.hpp"

robosync::kernel::Kernel robosync_kernel;

namespace {

using namespace robosync::kernel;
namespace core = robosync::port::core;

// Seconds of virtual time to run; run_stress.sh makes QEMU write them there.
std::uint32_t seconds() {
  return *reinterpret_cast<const volatile std::uint32_t*>(0x2100'0000);
}

constexpr unsigned kWorkers = 40;
constexpr unsigned kMutexes = 3;

// The naive policy's own record of a thread.
struct Worker {
  Thread thread;
  alignas(32) std::array<std::byte, 384> stack;
  Events signalled;  // and perhaps not yet taken
  Events wanted;     // 0: it waits for none
  Time deadline;
  bool waits;  // or is about to
};
std::array<Worker, kWorkers> workers;
std::array<Mutex, kMutexes> mutexes = {Mutex{Category::control}, Mutex{Category::behavior},
                                       Mutex{Category::processing}};
constexpr std::array kCeilings = {Category::control, Category::behavior, Category::processing};
std::array<Thread*, kMutexes> holders{};
// While priorities change, only the threads of its category use a mutex: the others might rise
// above its ceiling.
bool adapting = false;
unsigned users = 0;  // threads that use a mutex, or are about to

Thread adapter;
alignas(32) std::array<std::byte, 384> adapter_stack;

std::uint32_t decisions = 0;
std::uint32_t interrupts = 0;
std::uint32_t in_ticks = 0;                     // … that came while the tick was waking threads
std::uint32_t changes = 0;                      // of priorities
std::array<std::uint32_t, 1024> interrupted{};  // a bit for each halfword of flash
Draw chance{2463534242U};

void print_number(std::uint32_t number) {
  std::array<char, 11> text{};
  std::size_t at = text.size() - 1;
  do {
    text[--at] = static_cast<char>('0' + number % 10);
    number /= 10;
  } while (number != 0);
  semihosting::print(&text[at]);
}

[[noreturn]] void fail(const char* what, const Thread& runs, const Thread* should) {
  semihosting::print("FAIL ");
  semihosting::print(what);
  semihosting::print(": runs rank ");
  print_number(runs.rank());
  semihosting::print(", should rank ");
  print_number(should == nullptr ? 99 : should->rank());
  semihosting::print(" after decision ");
  print_number(decisions);
  semihosting::print("\n0 passed, 1 failed\n");
  semihosting::exit(1);
}

unsigned ceiling_of(unsigned mutex) {
  unsigned rank = 0;
  for (const Thread* thread : robosync_kernel.threads()) {
    if (thread->category() == kCeilings[mutex]) return rank;
    ++rank;
  }
  return rank;
}

// The policy: the highest thread that can run, unless a thread holds a mutex whose ceiling is not
// below it; then that holder, with several mutexes that of the latest.
const Thread* highest_ready() {
  for (const Thread* thread : robosync_kernel.threads())
    if (robosync_kernel.state(*thread) == Thread::State::ready) return thread;
  return &robosync_kernel.idle();
}

const Thread* should_run() {
  const Thread* best = highest_ready();
  unsigned best_rank = best->rank();
  for (unsigned m = 0; m < kMutexes; ++m) {
    if (holders[m] == nullptr || ceiling_of(m) > best_rank) continue;
    best_rank = ceiling_of(m);
    best = holders[m];
  }
  return best;
}

bool switch_is_pending() {
  return (core::reg(core::kIcsr) & core::kIcsrPendSvSet) != 0;
}
bool switch_is_active() {
  return (core::reg(core::kShcsr) & 1U << 10) != 0;
}
bool tick_is_active() {
  return (core::reg(core::kShcsr) & 1U << 11) != 0;
}
// If so, a deadline may have passed whose thread is still to be woken.
bool tick_is_due() {
  return tick_is_active() || (core::reg(core::kIcsr) & core::kIcsrSysTickSet) != 0;
}

// Has it got an event that it waits for, or has its time passed? According to the record, not the kernel.
bool can_surely_run(const Worker& worker) {
  return !worker.waits || (worker.signalled & worker.wanted) != 0 ||
         (worker.deadline <= robosync_kernel.now() && !tick_is_due());
}

// False between taking or releasing a mutex and recording that.
bool book_is_right() {
  for (unsigned m = 0; m < kMutexes; ++m)
    if (mutexes[m].held() != (holders[m] != nullptr)) return false;
  return true;
}

// Call it with the kernel locked and no switch pending.
void compare_decision() {
  if (!book_is_right()) return;
  const Thread& runs = robosync_kernel.current();
  const Thread* const should = should_run();
  if (&runs != should) fail("the wrong thread", runs, should);
  for (const Worker& worker : workers)
    if (can_surely_run(worker) && robosync_kernel.state(worker.thread) != Thread::State::ready)
      fail("a wake-up is lost", runs, &worker.thread);
  ++decisions;
}

void signal(Worker& to, Events events) {
  const auto lock = robosync_kernel.lock_interrupts();
  to.signalled |= events;
  robosync_kernel.signal(to.thread, events);
}

void wait(Worker& self, Events mask, Time deadline) {
  {
    const auto lock = robosync_kernel.lock_interrupts();
    self.wanted = mask;
    self.deadline = deadline;
    self.waits = true;
  }
  // The record becomes true when the thread has begun to wait. Therefore others check only threads that
  // are ready. A wait that ends immediately changes nothing.
  robosync_kernel.wait(mask, deadline);
  const auto lock = robosync_kernel.lock_interrupts();
  self.waits = false;
  self.signalled = 0;
}

void compute(std::uint32_t rounds) {
  for (std::uint32_t i = 0; i < rounds; ++i)
    asm volatile("");
}

bool may_use(const Worker& self, unsigned mutex) {
  if (adapting) return self.thread.category() == kCeilings[mutex];
  return self.thread.rank() >= ceiling_of(mutex);
}

void use_mutex(Worker& self, Draw& draw, unsigned mutex) {
  {
    const auto lock = robosync_kernel.lock_interrupts();
    if (!may_use(self, mutex)) return;
    ++users;
  }
  robosync_kernel.acquire(mutexes[mutex]);
  if (holders[mutex] != nullptr) fail("a mutex held by two", self.thread, holders[mutex]);
  holders[mutex] = &self.thread;
  compute(draw.below(60));
  signal(workers[draw.below(kWorkers)], 1U << draw.below(4));
  if (mutex + 1 < kMutexes && draw.below(3) == 0) use_mutex(self, draw, mutex + 1);
  compute(draw.below(60));
  holders[mutex] = nullptr;
  robosync_kernel.release(mutexes[mutex]);
  const auto lock = robosync_kernel.lock_interrupts();
  --users;
}

void work(void* argument) {
  Worker& self = *static_cast<Worker*>(argument);
  Draw draw(1 + static_cast<std::uint32_t>(&self - workers.data()) * 7919U);
  while (true) {
    switch (draw.below(4)) {
      case 0:
        use_mutex(self, draw, draw.below(kMutexes));
        break;
      case 1:
        compute(draw.below(200));
        break;
      default:
        signal(workers[draw.below(kWorkers)], 1U << draw.below(4));
    }
    if (draw.below(2) == 0)
      wait(self, draw.below(16), robosync_kernel.now() + kTick * draw.of_any_size(14));
  }
}

// --- priorities ---

Standing standing_of(const Thread& thread) {
  return standing(thread.category(), thread.priority());
}

void check_order() {
  const auto lock = robosync_kernel.lock_interrupts();
  const auto threads = robosync_kernel.threads();
  for (unsigned rank = 0; rank + 1 < threads.size(); ++rank)
    if (threads[rank]->rank() != rank ||
        standing_of(*threads[rank]) < standing_of(*threads[rank + 1]))
      fail("the order is wrong", *threads[rank], threads[rank + 1]);
  if (!switch_is_pending()) compare_decision();
}

void begin_or_end_adapting(bool begin) {
  while (true) {
    {
      const auto lock = robosync_kernel.lock_interrupts();
      if (users == 0) {
        adapting = begin;
        return;
      }
    }
    robosync_kernel.sleep_until(robosync_kernel.now() + kTick);
  }
}

// Alternates between a time with changes and one without.
void adapt(void*) {
  Draw draw(48271);
  while (true) {
    begin_or_end_adapting(true);
    for (unsigned left = draw.below(400); left > 0; --left) {
      const unsigned whose = draw.below(kWorkers + 1);
      Thread& thread = whose == kWorkers ? adapter : workers[whose].thread;
      const auto now = static_cast<std::int8_t>(draw.below(12));
      robosync_kernel.set_priority(thread, {now, thread.priority().base});
      check_order();
      ++changes;
      if (draw.below(4) == 0)
        robosync_kernel.sleep_until(robosync_kernel.now() + kTick * draw.of_any_size(6));
    }
    begin_or_end_adapting(false);
    robosync_kernel.sleep_until(robosync_kernel.now() + kTick * draw.below(500));
  }
}

// --- interrupts ---

constexpr unsigned kTimer0Interrupt = 8;
constexpr unsigned kJudgement = robosync::boards::mps2::kFreeInterrupt;
struct TimerRegisters {  // CMSDK APB timer
  volatile std::uint32_t control, value, reload, interrupt;
};
TimerRegisters& timer() {
  return *reinterpret_cast<TimerRegisters*>(0x4000'0000);
}

void interrupt_after(std::uint32_t cycles) {
  timer().control = 0;
  timer().reload = cycles;
  timer().value = cycles;
  timer().control = 0b1001;
}

// Records where a thread was interrupted.
void note_where() {
  std::uint32_t frame = 0;
  asm volatile("mrs %0, psp" : "=r"(frame));
  const std::uint32_t pc = reinterpret_cast<const std::uint32_t*>(frame)[6];
  const std::uint32_t bit = pc / 2 % (interrupted.size() * 32);
  interrupted[bit / 32] |= 1U << bit % 32;
}

std::uint32_t places() {
  std::uint32_t count = 0;
  for (const std::uint32_t word : interrupted)
    count += static_cast<std::uint32_t>(std::popcount(word));
  return count;
}

void conclude(void*) {
  robosync_kernel.sleep_until(Time{seconds()} * 1'000'000);
  print_number(decisions);
  semihosting::print(" decisions compared, ");
  print_number(changes);
  semihosting::print(" changes of priority, ");
  print_number(interrupts);
  semihosting::print(" interrupts at ");
  print_number(places());
  semihosting::print(" places in the code and ");
  print_number(in_ticks);
  semihosting::print(" in the tick, in ");
  print_number(seconds());
  semihosting::print(" seconds\n1 passed, 0 failed\n");
  semihosting::exit(0);
}

Thread conclusion;
alignas(32) std::array<std::byte, 512> conclusion_stack;

bool start() {
  constexpr std::array kKinds = {Category::sensor, Category::processing, Category::behavior,
                                 Category::control};
  ThreadSpec spec;
  for (unsigned i = 0; i < kWorkers; ++i) {
    spec.category = kKinds[i % kKinds.size()];
    spec.priority = static_cast<std::int16_t>(i * 37 % 11);
    spec.entry = work;
    spec.argument = &workers[i];
    spec.stack = workers[i].stack;
    if (!robosync_kernel.add(workers[i].thread, spec)) return false;
  }
  spec.category = Category::processing;
  spec.priority = 5;
  spec.entry = adapt;
  spec.stack = adapter_stack;
  if (!robosync_kernel.add(adapter, spec)) return false;
  spec.category = Category::safety;
  spec.entry = conclude;
  spec.stack = conclusion_stack;
  return robosync_kernel.add(conclusion, spec);
}

}  // namespace

extern "C" {

// The comparison after a context switch, unless an interrupt has already requested another switch.
void TestsOwn_Handler();
void TestsOwn_Handler() {
  const auto lock = robosync_kernel.lock_interrupts();
  if (!switch_is_pending()) compare_decision();
}

// Leaves lr and r4–r11 as the switch expects them.
[[gnu::naked]] void __wrap_PendSV_Handler();  // NOLINT: --wrap
void __wrap_PendSV_Handler() {                // NOLINT
  asm volatile(
      "movw r0, #0xE200\n\tmovt r0, #0xE000\n"  // NVIC_ISPR0
      "mov.w r1, %0\n\tstr r1, [r0]\n"
      "b __real_PendSV_Handler" ::"i"(1U << kJudgement));
}

void Timer0_Handler();
void Timer0_Handler() {
  timer().interrupt = 1;
  ++interrupts;
  if (!switch_is_active()) {
    if (tick_is_active()) {
      ++in_ticks;
    } else {
      note_where();
    }
    if (!switch_is_pending() && chance.below(4) == 0) compare_decision();
  }
  signal(workers[chance.below(kWorkers)], 1U << chance.below(4));
  if (chance.below(2) == 0) signal(workers[chance.below(kWorkers)], 1U << chance.below(4));
  interrupt_after(1 + (chance.below(4) == 0 ? chance.of_any_size(22) : chance.below(400)));
}
}

namespace robosync::port::hooks {

void thread_faulted(kernel::Thread& thread, const link::Fault&) {
  fail("a fault", thread, nullptr);
}
void fatal_fault(const link::Fault&) {
  fail("a fault", robosync_kernel.current(), nullptr);
}

}  // namespace robosync::port::hooks

int main() {
  if (!start()) semihosting::exit(2);
  core::enable_interrupt(kTimer0Interrupt);
  core::enable_interrupt(kJudgement, core::kSwitchPriority);
  interrupt_after(1000);
  robosync_kernel.run();
}
