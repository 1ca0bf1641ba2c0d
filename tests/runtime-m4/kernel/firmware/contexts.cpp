// Kernel services called from contexts where they are not allowed: from an interrupt, from one
// above the kernel's level, under a lock. The assertion reports it, and the call has no effect.
//
// The assertion jumps back to the test, since the failing context is not reliable.
#include <csetjmp>
#include <cstring>

#include "runtime-m4/kernel/assertions.hpp"
#include "runtime-m4/port/cortex-m4/core.hpp"
#include "tests/runtime-m4/kernel/firmware/rig.hpp"

namespace {

namespace core = robosync::port::core;
using robosync::kernel::Mutex;
using robosync::kernel::ThreadSpec;

constexpr unsigned kInterrupt = 20;  // no device uses it: software pends it

std::jmp_buf back;
const char* failed_service = nullptr;
const char* failed_why = nullptr;

void note_failure(const char* service, const char* why) {
  failed_service = service;
  failed_why = why;
  std::longjmp(back, 1);
}

// Whether that call of `service` fails for that reason.
bool fails(void (*call)(), const char* service, const char* why) {
  failed_service = "";
  failed_why = "";
  const robosync::kernel::AssertionFailed before = robosync::kernel::assertion_failed;
  robosync::kernel::assertion_failed = note_failure;
  if (setjmp(back) == 0) call();
  robosync::kernel::assertion_failed = before;
  return std::strcmp(failed_service, service) == 0 && std::strcmp(failed_why, why) == 0;
}

// --- from an interrupt ---

struct Call {
  void (*call)();
  const char* service;
  const char* why;
};
const Call* called = nullptr;
volatile bool failed_as_said = false;

Mutex mutex{rig::Category::safety};
rig::Thread other;
ThreadSpec spec;

void pend(const Call& call, std::uint32_t priority) {
  called = &call;
  failed_as_said = false;
  core::enable_interrupt(kInterrupt, static_cast<std::uint8_t>(priority));
  core::pend_interrupt(kInterrupt);
  asm volatile("dsb\n\tisb" ::: "memory");
}

constexpr const char* kNoThread = "not from a thread";
constexpr const char* kHandler = "from an interrupt handler";
constexpr const char* kUrgent = "from an interrupt above the kernel's level";

constexpr Call kFromHandler[] = {
    {[] { robosync_kernel.wait(1); }, "wait", kNoThread},
    {[] { robosync_kernel.sleep_until(0); }, "sleep_until", kNoThread},
    {[] { robosync_kernel.acquire(mutex); }, "acquire", kNoThread},
    {[] { robosync_kernel.release(mutex); }, "release", kNoThread},
    {[] { (void)robosync_kernel.add(other, spec); }, "add", kHandler},
    {[] { robosync_kernel.remove(other); }, "remove", kHandler},
    {[] { robosync_kernel.set_priority(other, {}); }, "set_priority", kHandler},
    {[] { robosync_kernel.watch(other, 1, 2); }, "watch", kHandler},
    {[] { robosync_kernel.grant({}); }, "grant", kHandler},
    {[] { robosync_kernel.run(); }, "run", "when threads run already"},
    {[] { robosync_kernel.stop(other); }, "stop", "from a handler, and not the running thread"},
};

void services_in_a_handler() {
  for (const Call& call : kFromHandler) {
    pend(call, core::kKernelPriority);
    CHECK(failed_as_said);
  }
}

constexpr Call kFromAbove[] = {
    {[] { robosync_kernel.signal(other, 1); }, "signal", kUrgent},
    {[] { (void)robosync_kernel.now(); }, "now", kUrgent},
    {[] { (void)robosync_kernel.lock(); }, "lock", kUrgent},
    {[] { (void)robosync_kernel.lock_interrupts(); }, "lock_interrupts", kUrgent},
    {[] { (void)robosync_kernel.run_time(other); }, "run_time", kUrgent},
};

void services_above_the_kernel() {
  for (const Call& call : kFromAbove) {
    pend(call, core::kKernelPriority / 2);
    CHECK(failed_as_said);
  }
}

constexpr Call kAllowed{[] {
                          robosync_kernel.signal(other, 1);
                          (void)robosync_kernel.now();
                          (void)robosync_kernel.lock();
                        },
                        "", ""};

void services_that_may_be_called() {
  pend(kAllowed, core::kKernelPriority);
  CHECK(failed_as_said);
  pend(kAllowed, core::kSwitchPriority);
  CHECK(failed_as_said);
}

// --- from a thread ---

void services_under_a_lock() {
  {
    const auto lock = robosync_kernel.lock();
    CHECK(fails([] { robosync_kernel.wait(1); }, "wait", "while a lock is held"));
    CHECK(fails([] { robosync_kernel.acquire(mutex); }, "acquire", "while a lock is held"));
  }
  const auto lock = robosync_kernel.lock_interrupts();
  CHECK(fails([] { robosync_kernel.sleep_until(0); }, "sleep_until", "while a lock is held"));
  CHECK(fails([] { (void)robosync_kernel.add(other, spec); }, "add",
              "while interrupts are held off"));
  CHECK(fails([] { robosync_kernel.remove(other); }, "remove", "while interrupts are held off"));
}

void services_with_a_mutex() {
  CHECK(fails([] { robosync_kernel.release(mutex); }, "release",
              "by a thread that does not hold it"));
  const robosync::kernel::MutexGuard mine(robosync_kernel, mutex);
  CHECK(fails([] { robosync_kernel.wait(1); }, "wait", "while it holds a mutex"));
}

void removing_oneself() {
  CHECK(fails([] { robosync_kernel.remove(rig::conductor()); }, "remove", "of the running thread"));
}

constexpr rig::Scenario kScenarios[] = {
    {"assertions: what is for threads, in an interrupt", services_in_a_handler},
    {"assertions: anything in an interrupt above the kernel's level", services_above_the_kernel},
    {"assertions: what an interrupt may call", services_that_may_be_called},
    {"assertions: what blocks or takes long, under a lock", services_under_a_lock},
    {"assertions: a mutex is given back before its holder waits", services_with_a_mutex},
    {"assertions: no thread removes itself", removing_oneself},
};

}  // namespace

extern "C" void TestsOwn_Handler();
void TestsOwn_Handler() {
  failed_as_said = fails(called->call, called->service, called->why);
}

std::span<const rig::Scenario> rig::context_scenarios() {
  return kScenarios;
}
