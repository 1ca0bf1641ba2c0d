// The vector tables of a board with a Cortex-M4: the core's own exceptions, which are the same
// everywhere, followed by the interrupts that the board uses.
//
// A board's interrupts.hpp declares how many interrupts there are (kInterrupts) and which are used (kUsedInterrupts);
// vectors.cpp makes the tables.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>

extern "C" {

extern std::uint32_t main_stack_top;  // from the linker script
[[noreturn]] void Reset_Handler();
void NMI_Handler();
void HardFault_Handler();
void MemManage_Handler();
void BusFault_Handler();
void UsageFault_Handler();
void SVC_Handler();
void SVC_Sandbox_Handler();
void PendSV_Handler();
void PendSV_Unprivileged_Handler();
void SysTick_Handler();
void Unexpected_Handler();

}  // extern "C"

namespace robosync::boards {

union Vector {
  const std::uint32_t* stack;
  void (*handler)();
};
struct Interrupt {
  unsigned number;
  void (*handler)();
};

inline constexpr std::size_t kExceptions = 16;  // including the initial stack pointer
template <std::size_t kInterrupts>
using Vectors = std::array<Vector, kExceptions + kInterrupts>;

// VTOR requires the table's size, rounded up to a power of two.
template <std::size_t kInterrupts>
inline constexpr std::size_t kVectorAlignment = std::bit_ceil(sizeof(Vectors<kInterrupts>));

// `kInterrupts` is the number of interrupts that the processor has; `used` are those with a handler.
template <std::size_t kInterrupts>
constexpr Vectors<kInterrupts> vectors(std::span<const Interrupt> used, bool privileged) {
  const auto handler = [](void (*function)()) { return Vector{.handler = function}; };
  Vectors<kInterrupts> table{};
  table.fill(handler(Unexpected_Handler));
  table[0] = {.stack = &main_stack_top};
  table[1] = handler(Reset_Handler);
  table[2] = handler(NMI_Handler);
  table[3] = handler(HardFault_Handler);
  table[4] = handler(MemManage_Handler);
  table[5] = handler(BusFault_Handler);
  table[6] = handler(UsageFault_Handler);
  table[11] = handler(privileged ? SVC_Sandbox_Handler : SVC_Handler);
  table[14] = handler(privileged ? PendSV_Handler : PendSV_Unprivileged_Handler);
  table[15] = handler(SysTick_Handler);
  for (const Interrupt& interrupt : used)
    table[kExceptions + interrupt.number] = handler(interrupt.handler);
  return table;
}

}  // namespace robosync::boards
