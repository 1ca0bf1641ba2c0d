// The core registers of the Cortex-M4 that the port and the boards use; those of SysTick are in systick.hpp.
// Names as in the ARMv7-M manual.
#pragma once

#include <cstdint>

namespace robosync::port::core {

inline volatile std::uint32_t& reg(std::uintptr_t address) {
  return *reinterpret_cast<volatile std::uint32_t*>(address);  // NOLINT(performance-no-int-to-ptr)
}

inline constexpr std::uintptr_t kNvicIser = 0xE000'E100;  // interrupt set-enable
inline constexpr std::uintptr_t kNvicIspr = 0xE000'E200;  // interrupt set-pending
inline constexpr std::uintptr_t kNvicIcpr = 0xE000'E280;  // interrupt clear-pending
inline constexpr std::uintptr_t kNvicIpr = 0xE000'E400;   // interrupt priorities, a byte each
inline constexpr std::uintptr_t kIcsr = 0xE000'ED04;      // interrupt control and state
inline constexpr std::uintptr_t kVtor = 0xE000'ED08;      // where the vector table is
inline constexpr std::uintptr_t kAircr = 0xE000'ED0C;     // reset control
inline constexpr std::uintptr_t kCcr = 0xE000'ED14;       // traps
inline constexpr std::uintptr_t kShpr1 = 0xE000'ED18;     // priorities of the faults
inline constexpr std::uintptr_t kShpr2 = 0xE000'ED1C;     // priority of SVC
inline constexpr std::uintptr_t kShpr3 = 0xE000'ED20;     // priorities of PendSV and SysTick
inline constexpr std::uintptr_t kShcsr = 0xE000'ED24;     // enables of the fault handlers
inline constexpr std::uintptr_t kCfsr = 0xE000'ED28;      // what kind of fault
inline constexpr std::uintptr_t kMmfar = 0xE000'ED34;     // address of a MemManage fault
inline constexpr std::uintptr_t kBfar = 0xE000'ED38;      // address of a BusFault
inline constexpr std::uintptr_t kCpacr = 0xE000'ED88;     // access to the FPU

inline constexpr std::uintptr_t kMpuCtrl = 0xE000'ED94;  // MPU on
inline constexpr std::uintptr_t kMpuRbar = 0xE000'ED9C;  // MPU region: number and base
inline constexpr std::uintptr_t kMpuRasr = 0xE000'EDA0;  // … size and access

inline constexpr std::uint32_t kIcsrPendSvSet = 1U << 28;
inline constexpr std::uint32_t kIcsrSysTickSet = 1U << 26;
inline constexpr std::uint32_t kCcrDivideByZeroTrap = 1U << 4;
inline constexpr std::uint32_t kShcsrFaultHandlers = 7U << 16;  // MemManage, BusFault, UsageFault
inline constexpr std::uint32_t kShcsrCallPending = 1U << 15;    // SVCALLPENDED
inline constexpr std::uint32_t kCfsrDataAccess = 1U << 1;       // MemManage: address in MMFAR
inline constexpr std::uint32_t kCfsrMemoryStacking = 1U << 4;   // MemManage: frame not stacked
inline constexpr std::uint32_t kCfsrMmarValid = 1U << 7;
inline constexpr std::uint32_t kCfsrBfarValid = 1U << 15;

// Where no region applies, privileged code has access as without an MPU, and other code has none.
inline constexpr std::uint32_t kMpuOn = 0b101;
inline constexpr std::uint32_t kMpuBaseValid = 1U << 4;  // RBAR names its region

// RASR: access rights. The type is always normal memory, so that unaligned accesses work.
inline constexpr std::uint32_t kMpuNormal = 1U << 17;
inline constexpr std::uint32_t kMpuNeverExecute = 1U << 28;
inline constexpr std::uint32_t kMpuClosed = 0U << 24 | kMpuNormal | kMpuNeverExecute;
inline constexpr std::uint32_t kMpuPrivileged = 1U << 24 | kMpuNormal | kMpuNeverExecute;
inline constexpr std::uint32_t kMpuOthersRead = 2U << 24 | kMpuNormal | kMpuNeverExecute;
inline constexpr std::uint32_t kMpuAllWrite = 3U << 24 | kMpuNormal | kMpuNeverExecute;
inline constexpr std::uint32_t kMpuCode = 6U << 24 | kMpuNormal;  // read and execute, for all

// Interrupt priorities: a lower number is more urgent. The kernel's critical sections hold off
// interrupts of kKernelPriority and less urgent ones, which may call the kernel. More urgent ones are
// never held off and must not call it. All interrupts of the kernel's level have the same priority,
// so they do not nest. The switch and the tick have the lowest priority used: neither preempts the
// other, and neither delays an interrupt. A processor implements only the upper bits of a priority
// byte; the two used here always exist. (0xFF would not do: some emulators implement all eight bits
// of BASEPRI, and 0xFF then holds off no interrupt whose priority has four bits.)
inline constexpr std::uint32_t kKernelPriority = 0x40;
inline constexpr std::uint32_t kSwitchPriority = 0xC0;

// For the reset handler: turns the FPU on, and holds off interrupts of the kernel's level until
// Machine::run().
[[gnu::always_inline]] inline void prepare() {
  reg(kCpacr) = 0xFU << 20;
  reg(kShpr3) = (kSwitchPriority << 24) | (kSwitchPriority << 16);
  asm volatile("msr basepri, %0\n\tdsb\n\tisb" ::"r"(kKernelPriority) : "memory");
}

// These NVIC registers hold 32 interrupts per word; writing 0 to the bits of the others has no effect.
inline void write_bit(std::uintptr_t registers, unsigned number) {
  reg(registers + std::uintptr_t{4} * (number / 32)) = 1U << (number % 32);
}

// Enables interrupt `number`, by default at the kernel's level.
inline void enable_interrupt(unsigned number, std::uint8_t priority = kKernelPriority) {
  auto* priorities =
      reinterpret_cast<volatile std::uint8_t*>(kNvicIpr);  // NOLINT(performance-no-int-to-ptr)
  priorities[number] = priority;
  write_bit(kNvicIser, number);
}

// Sets interrupt `number` pending.
inline void pend_interrupt(unsigned number) {
  write_bit(kNvicIspr, number);
}

// Clears its pending state.
inline void clear_interrupt(unsigned number) {
  write_bit(kNvicIcpr, number);
}

[[noreturn]] inline void reset() {
  reg(kAircr) = 0x05FA'0004;  // key, SYSRESETREQ
  asm volatile("dsb" ::: "memory");
  while (true) {
  }
}

}  // namespace robosync::port::core
