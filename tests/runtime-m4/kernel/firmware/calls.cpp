// System calls of unprivileged threads: what they do, and that they have no other effect,
// whatever their numbers and arguments are.
#include "runtime-m4/kernel/calls.hpp"

#include "tests/runtime-m4/kernel/firmware/draw.hpp"
#include "tests/runtime-m4/kernel/firmware/rig.hpp"

namespace {

namespace calls = robosync::kernel::calls;
using rig::Events;

constexpr unsigned kCaller = 1;
constexpr Events kPing = 1;
constexpr Events kPong = 2;
constexpr Events kOther = 4;
constexpr std::uint32_t kNoSuchCall = 1U << 21;  // port/cortex-m4/fault.hpp

enum Word : std::uint8_t { kTaken, kRounds, kSeed, kRanAgain };

// The granted area, accessed without a variable that holds its address.
volatile std::uint32_t& open(Word word) {
  std::uint32_t area = 0;
  asm("movw %0, #:lower16:granted_area_of_tests\n\tmovt %0, #:upper16:granted_area_of_tests"
      : "=r"(area));
  return reinterpret_cast<volatile std::uint32_t*>(area)[word];
}

// Reports each event.
void answer(void*) {
  while (true) {
    open(kTaken) = calls::wait(robosync_kernel, kPing | kOther);
    open(kRounds) = open(kRounds) + 1;
    calls::report(robosync_kernel);
  }
}

void wait_and_report() {
  robosync_kernel.watch(rig::conductor(), 0, kPong);
  rig::Thread& caller = rig::start_unprivileged(kCaller, 40, answer);
  for (unsigned round = 1; round <= 100; ++round) {
    robosync_kernel.signal(caller, round % 2 != 0 ? kPing : kOther);
    CHECK(robosync_kernel.wait(kPong, robosync_kernel.now() + 10'000) == kPong);
    CHECK(rig::granted_area()[kRounds] == round);
    CHECK(rig::granted_area()[kTaken] == (round % 2 != 0 ? kPing : kOther));
  }
  CHECK(rig::faults() == 0);
}

// The same with one call: it knows the event that wakes it.
void answer_and_rest(void*) {
  (void)calls::wait(robosync_kernel, kPing);
  while (true) {
    open(kRounds) = open(kRounds) + 1;
    calls::rest(robosync_kernel, kPing);
  }
}

void rest_until_woken() {
  robosync_kernel.watch(rig::conductor(), 0, kPong);
  rig::Thread& caller = rig::start_unprivileged(kCaller, 40, answer_and_rest);
  for (unsigned round = 1; round <= 100; ++round) {
    robosync_kernel.signal(caller, kPing);
    CHECK(robosync_kernel.wait(kPong, robosync_kernel.now() + 10'000) == kPong);
    CHECK(rig::granted_area()[kRounds] == round);
  }
  // Other events do not wake it.
  robosync_kernel.signal(caller, kOther);
  rig::sleep_ms(2);
  CHECK(rig::granted_area()[kRounds] == 100);
  CHECK(robosync_kernel.state(caller) == rig::Thread::State::blocked);
  CHECK(rig::faults() == 0);
}

// Takes one of two pending events, then the other one.
void take_one_by_one(void*) {
  open(kTaken) = calls::wait(robosync_kernel, kPing);
  open(kRounds) = calls::wait(robosync_kernel, kOther);
  calls::report(robosync_kernel);
  calls::wait(robosync_kernel, kPing | kOther);
}

void others_stay() {
  robosync_kernel.watch(rig::conductor(), 0, kPong);
  rig::Thread& caller = rig::start_unprivileged(kCaller, 40, take_one_by_one);
  robosync_kernel.signal(caller, kPing | kOther);
  CHECK(robosync_kernel.wait(kPong, robosync_kernel.now() + 10'000) == kPong);
  CHECK(rig::granted_area()[kTaken] == kPing);
  CHECK(rig::granted_area()[kRounds] == kOther);
}

// Events that come before the wait, and events that nobody waits for.
void events_are_kept() {
  robosync_kernel.watch(rig::conductor(), 0, kPong);
  rig::Thread& caller = rig::start_unprivileged(kCaller, 40, answer);
  robosync_kernel.signal(caller, kPing | kOther | 8);
  CHECK(robosync_kernel.wait(kPong, robosync_kernel.now() + 10'000) == kPong);
  CHECK(rig::granted_area()[kTaken] == (kPing | kOther));
  rig::sleep_ms(2);
  CHECK(rig::granted_area()[kRounds] == 1);
  CHECK(robosync_kernel.state(caller) == rig::Thread::State::blocked);
}

std::uint32_t draw(std::uint32_t& state) {
  return state = xorshift32(state);
}

// Calls with random registers; half of the call numbers exist.
void call_anything(void*) {
  std::uint32_t state = open(kSeed);
  while (true) {
    const std::uint32_t drawn = draw(state);
    const std::uint32_t number = (drawn & 2) != 0 ? (drawn >> 2) % 3 : drawn;
    const std::array<std::uint32_t, 3> others = {draw(state), draw(state), draw(state)};
    open(kSeed) = state;
    open(kRounds) = open(kRounds) + 1;
    register std::uint32_t r0 asm("r0") = number;
    register std::uint32_t r1 asm("r1") = others[0];
    register std::uint32_t r2 asm("r2") = others[1];
    register std::uint32_t r3 asm("r3") = others[2];
    asm volatile("svc 0" : "+r"(r0), "+r"(r1), "+r"(r2), "+r"(r3)::"memory");
  }
}

// A thread that is stopped because of its call is restarted with the next seed. One that waits gets
// the events that it may wait for.
void hostile_calls() {
  constexpr unsigned kThreads = 2000;
  std::uint32_t seed = 12345;
  unsigned made = 0;
  unsigned waits = 0;
  robosync_kernel.watch(rig::conductor(), 0, kPong);
  rig::watch_safety();
  const robosync::kernel::Time begin = robosync_kernel.now();
  for (unsigned i = 0; i < kThreads; ++i) {
    rig::granted_area()[kRounds] = 0;
    rig::granted_area()[kSeed] = draw(seed);
    rig::Thread& caller = rig::start_unprivileged(kCaller, 60, call_anything);
    for (unsigned tries = 0; tries < 100; ++tries) {
      if (robosync_kernel.state(caller) != rig::Thread::State::blocked) break;
      ++waits;
      robosync_kernel.signal(caller, 0xFFFF'FFFF);
    }
    made += rig::granted_area()[kRounds];
    if (robosync_kernel.state(caller) == rig::Thread::State::stopped) {
      CHECK(rig::last_fault().cause == kNoSuchCall);
      CHECK(rig::last_fault().address == rig::last_fault().r[0]);
      CHECK(rig::last_fault().address > 1);
    }
    robosync_kernel.remove(caller);
  }
  CHECK(rig::faults() == kThreads);
  CHECK(made > kThreads);
  CHECK(waits > kThreads / 8);
  CHECK(rig::safety_lateness() == 0);
  CHECK(rig::safety_checks() == (robosync_kernel.now() - begin) / 10'000);
  robosync_kernel.wait(kPong, 0);
}

void run_again() {
  open(kRanAgain) = 1;
  while (true) {
  }
}

// At the place where a stopped thread's registers are expected, it leaves values that make its call
// rest(1), and make it continue in run_again() when it is signalled.
[[gnu::naked]] void calls_with_lost_stack(void*) {
  asm volatile(
      "sub  r0, sp, #32     \n"
      "movs r1, #2          \n"
      "movs r2, #1          \n"
      "strd r1, r2, [r0]    \n"
      "ldr  r1, =%c0        \n"
      "bic  r1, r1, #1      \n"
      "mov  r2, #0x01000000 \n"
      "strd r1, r2, [r0, #24] \n"
      "ldr  r0, =0x60000000 \n"
      "mov  sp, r0          \n"
      "movs r0, #0          \n"
      "svc  0               \n"
      "1: b 1b              \n"
      ".ltorg               \n" ::"i"(run_again));
}

// The call's frame cannot be stacked: that is one fault, and the call is not executed.
void call_without_stack() {
  rig::granted_area()[kRanAgain] = 0;
  rig::Thread& caller = rig::start_unprivileged(kCaller, 60, calls_with_lost_stack);
  rig::sleep_ms(2);
  CHECK(rig::faults() == 1);
  CHECK((rig::last_fault().cause & 1U << 4) != 0);
  CHECK(robosync_kernel.state(caller) == rig::Thread::State::stopped);
  robosync_kernel.signal(caller, 1);
  rig::sleep_ms(2);
  CHECK(rig::granted_area()[kRanAgain] == 0);
}

constexpr rig::Scenario kScenarios[] = {
    {"system calls: wait and report", wait_and_report},
    {"system calls: events are kept until they are waited for", events_are_kept},
    {"system calls: events that are not waited for stay", others_stay},
    {"system calls: a thread that rests until it is woken", rest_until_woken},
    {"system calls: thousands with drawn numbers and arguments", hostile_calls},
    {"system calls: without a stack to make them from", call_without_stack},
};

}  // namespace

std::span<const rig::Scenario> rig::call_scenarios() {
  return kScenarios;
}
