// The current mode and lock, for the kernel's assertions (kernel/assertions.hpp). Not in the firmware.
#include "runtime-m4/port/cortex-m4/machine.hpp"

namespace robosync::port {

namespace {

constexpr unsigned kFirstSystem = 4;  // MemManage, the first exception whose priority can be set
constexpr unsigned kFirstInterrupt = 16;

unsigned exception() {
  std::uint32_t number = 0;
  asm volatile("mrs %0, ipsr" : "=r"(number));
  return number;
}

std::uint32_t priority_of(unsigned exception) {
  const auto byte = [](std::uintptr_t registers, unsigned index) {
    return std::uint32_t{reinterpret_cast<const volatile std::uint8_t*>(registers)[index]};
  };
  if (exception >= kFirstInterrupt) return byte(core::kNvicIpr, exception - kFirstInterrupt);
  return byte(core::kShpr1, exception - kFirstSystem);
}

}  // namespace

Mode Machine::mode() {
  if (exception() != 0) return Mode::handler;
  std::uint32_t control = 0;
  asm volatile("mrs %0, control" : "=r"(control));
  constexpr std::uint32_t kUsesPsp = 1U << 1;
  return (control & kUsesPsp) != 0 ? Mode::thread : Mode::init;
}

Held Machine::held() {
  std::uint32_t level = 0;
  asm volatile("mrs %0, basepri" : "=r"(level));
  if (level == 0) return Held::none;
  return level <= core::kKernelPriority ? Held::lock : Held::switch_lock;
}

// A fault handler runs at a higher level, but acts for the thread that faulted, and calls the kernel
// only if that thread holds no lock (fault.cpp).
bool Machine::may_call() {
  constexpr unsigned kLastFault = 6;
  const unsigned number = exception();
  if (number == 0 || (number >= kFirstSystem && number <= kLastFault)) return true;
  return number > kLastFault && priority_of(number) >= core::kKernelPriority;
}

void panic(const char*, const char*) {
  __builtin_trap();
}

}  // namespace robosync::port
