// From reset to main(): vector tables, FPU, memory, constructors. Nothing here may use the FPU
// before it is on, or .data and .bss before they are set up.
#include <array>
#include <cstddef>
#include <cstdint>

#include "runtime-m4/boards/mps2-an386/board.hpp"
#include "runtime-m4/port/cortex-m4/core.hpp"

extern "C" {

// From the linker script.
extern std::uint32_t main_stack_top, data_start, data_end, data_image, bss_start, bss_end;
using Constructor = void (*)();
extern const Constructor init_array_start, init_array_end;

int main();
[[noreturn]] void Reset_Handler();
void NMI_Handler();
void HardFault_Handler();
void MemManage_Handler();
void BusFault_Handler();
void UsageFault_Handler();
void SVC_Handler();
void PendSV_Handler();
void PendSV_Open_Handler();
void SysTick_Handler();
void Uart0Receive_Handler();
void Uart0Transmit_Handler();
void Unexpected_Handler();
// Timer 0 is nobody's in the firmware; the kernel's tests take it.
[[gnu::weak, gnu::alias("Unexpected_Handler")]] void Timer0_Handler();
void __cxa_pure_virtual();  // NOLINT: the compiler asks for this name

void __cxa_pure_virtual() {
  asm volatile("udf #0");
}

// An interrupt that nobody enabled: memory or hardware is not what it should be.
void Unexpected_Handler() {
  robosync::link::Fault fault{};
  asm volatile("mrs %0, ipsr" : "=r"(fault.xpsr));
  robosync::boards::mps2::reset_after(fault);
}

}  // extern "C"

namespace {

union Vector {
  const std::uint32_t* stack;
  void (*handler)();
};

constexpr Vector handler(void (*function)()) {
  return {.handler = function};
}

constexpr Vector kUnexpected = {.handler = Unexpected_Handler};

using Vectors = std::array<Vector, 16 + 32>;

// The second one is used while a thread without privileges runs: such a thread may call, and is
// left in another way (port/cortex-m4/switch.S).
constexpr Vectors table(bool open) {
  Vectors table{};
  table.fill(kUnexpected);
  table[0] = {.stack = &main_stack_top};
  table[1] = handler(Reset_Handler);
  table[2] = handler(NMI_Handler);
  table[3] = handler(HardFault_Handler);
  table[4] = handler(MemManage_Handler);
  table[5] = handler(BusFault_Handler);
  table[6] = handler(UsageFault_Handler);
  if (open) table[11] = handler(SVC_Handler);
  table[14] = handler(open ? PendSV_Open_Handler : PendSV_Handler);
  table[15] = handler(SysTick_Handler);
  table[16] = handler(Uart0Receive_Handler);
  table[17] = handler(Uart0Transmit_Handler);
  table[24] = handler(Timer0_Handler);
  return table;
}

constexpr std::size_t kTableAlignment = 256;  // VTOR: the next power of two

}  // namespace

extern "C" {
[[gnu::section(".vectors.0"),
  gnu::used]] alignas(kTableAlignment) extern const Vectors robosync_vectors = table(false);
[[gnu::section(".vectors.1"),
  gnu::used]] alignas(kTableAlignment) extern const Vectors robosync_open_vectors = table(true);
}

void Reset_Handler() {
  namespace core = robosync::port::core;
  core::prepare();
  const std::uint32_t* from = &data_image;
  for (std::uint32_t* to = &data_start; to < &data_end; ++to)
    *to = *from++;
  for (std::uint32_t* to = &bss_start; to < &bss_end; ++to)
    *to = 0;
  for (const Constructor* constructor = &init_array_start; constructor < &init_array_end;
       ++constructor) {
    (*constructor)();
  }
  main();
  core::reset();
}
