// The Cortex-M4 as a machine for the kernel. There is one, and it runs `robosync_kernel`.
//
// Threads run on PSP, handlers on MSP. The switch is PendSV at the lowest priority (switch.S).
// Critical sections raise BASEPRI: interrupts above the kernel's level are never held off. Until
// run() the kernel's level is held off altogether (the board's reset handler sees to that).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "runtime-m4/port/cortex-m4/core.hpp"

// A free-running counter of the core's clock that counts down; the board's linker script says where
// it is, and the board starts it.
extern "C" const volatile std::uint32_t robosync_clock;

namespace robosync::kernel {
class Kernel;
struct ThreadSpec;
}  // namespace robosync::kernel

namespace robosync::port {

// Below each stack stand 32 bytes that nobody may touch while its thread runs: the MPU makes a
// fault of the first access. Bytes between a stack's start and what a thread can use of it:
inline constexpr std::size_t kGuard = 32;
inline constexpr bool kTimeFlows = true;
inline constexpr std::size_t kStackAlignment = kGuard;  // any other alignment wastes bytes
inline constexpr std::size_t kGuardRegion = 7;          // of the MPU; the highest number wins

// Alignment and guard, what the core stacks with FPU registers, and what switch.S adds.
inline constexpr std::size_t kMinStack = kGuard - 8 + kGuard + 104 + 100;

struct Context {
  std::uint32_t* sp = nullptr;  // r4–r11 and EXC_RETURN stand there, below the core's own frame
  std::uint32_t guard = 0;      // for the MPU's base register
};

class Machine {
public:
  explicit Machine(kernel::Kernel&) {}
  void prepare(Context& context, const kernel::ThreadSpec& spec, std::span<std::byte> stack);
  static std::uint32_t clock() { return robosync_clock; }
  void request_switch() { core::reg(core::kIcsr) = core::kIcsrPendSvSet; }
  [[noreturn]] void run();
  static std::span<std::byte> usable(std::span<std::byte> stack);
  static std::span<std::byte> prepare_idle(Context& context);
};

inline std::uint32_t fetch_and_clear(std::uint32_t& word, std::uint32_t mask) {
  std::uint32_t before, after, failed;
  asm volatile(
      "1: ldrex %0, %3        \n"
      "bic   %1, %0, %4       \n"
      "strex %2, %1, %3       \n"
      "cmp   %2, #0           \n"
      "bne   1b               \n"
      : "=&r"(before), "=&r"(after), "=&r"(failed), "+m"(word)
      : "r"(mask)
      : "cc", "memory");
  return before;
}

// Never make one const: GCC then keeps it in memory ("store to a read-only decl" stops its scalar
// replacement), which costs four instructions in every path.
class Lock {
public:
  explicit Lock(const Machine&) : outer_(raise()) {}
  // A switch that was requested under the lock happens here, give or take an instruction: without
  // a barrier the core may finish what it has fetched. Waiting does not rely on it.
  ~Lock() { asm volatile("msr basepri, %0" ::"r"(outer_) : "memory"); }
  Lock(const Lock&) = delete;
  Lock& operator=(const Lock&) = delete;

private:
  static std::uint32_t raise() {
    std::uint32_t outer;
    asm volatile("mrs %0, basepri\n\tmsr basepri_max, %1"
                 : "=&r"(outer)
                 : "r"(core::kKernelPriority)
                 : "memory");
    return outer;
  }

  std::uint32_t outer_;
};

}  // namespace robosync::port
