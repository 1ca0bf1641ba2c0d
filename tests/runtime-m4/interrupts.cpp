// See interrupts.hpp.
#include "tests/runtime-m4/interrupts.hpp"

#include "runtime-m4/kernel/assertions.hpp"

namespace robosync::test {

namespace {
Interrupts* present = nullptr;
}  // namespace

// A test calls on_tick() from a thread, as if an interrupt had come there. The assertions would refuse that.
Interrupts::Interrupts() : assertion_failed_(kernel::assertion_failed) {
  present = this;
  kernel::assertion_failed = [](const char*, const char*) {};
}

Interrupts::~Interrupts() {
  present = nullptr;
  kernel::assertion_failed = assertion_failed_;
}

}  // namespace robosync::test

namespace robosync {

void real_signal(kernel::Kernel* kernel, kernel::Thread& thread, kernel::Events events) asm(
    "__real__ZN8robosync6kernel6Kernel6signalERNS0_6ThreadEj");
void wrapped_signal(kernel::Kernel* kernel, kernel::Thread& thread, kernel::Events events) asm(
    "__wrap__ZN8robosync6kernel6Kernel6signalERNS0_6ThreadEj");
std::uint32_t real_call(kernel::Kernel& kernel, std::uint32_t number, std::uint32_t argument) asm(
    "__real__ZN8robosync4port4callERNS_6kernel6KernelEjj");
std::uint32_t wrapped_call(
    kernel::Kernel& kernel, std::uint32_t number,
    std::uint32_t argument) asm("__wrap__ZN8robosync4port4callERNS_6kernel6KernelEjj");

void wrapped_signal(kernel::Kernel* kernel, kernel::Thread& thread, kernel::Events events) {
  if (test::present != nullptr && test::present->before_signal)
    test::present->before_signal(thread);
  real_signal(kernel, thread, events);
}

std::uint32_t wrapped_call(kernel::Kernel& kernel, std::uint32_t number, std::uint32_t argument) {
  if (test::present != nullptr && test::present->before_call) test::present->before_call(number);
  return real_call(kernel, number, argument);
}

}  // namespace robosync
