// Vector tables and reset of the bench firmware. QEMU loads the ELF at its run addresses (bare.ld) into zeroed memory, so there
// is nothing to copy or clear. After a fault, the measurement has failed.
#include <cstdint>

#include "bench/firmware/mark.hpp"

extern "C" {

using Handler = void (*)();
extern const std::uint32_t stack_top;  // bare.ld
extern const Handler init_array_begin[], init_array_end[];

int main();
void reset();
void fault() {
  robosync::bench::leave(false);
}

// The kernel's port and the fuzzer's sandbox define their own.
[[gnu::weak, gnu::alias("fault")]] void HardFault_Handler();
[[gnu::weak, gnu::alias("fault")]] void MemManage_Handler();
[[gnu::weak, gnu::alias("fault")]] void BusFault_Handler();
[[gnu::weak, gnu::alias("fault")]] void UsageFault_Handler();
[[gnu::weak, gnu::alias("fault")]] void SVC_Handler();
[[gnu::weak, gnu::alias("fault")]] void PendSV_Handler();
[[gnu::weak, gnu::alias("fault")]] void PendSV_Unprivileged_Handler();
[[gnu::weak, gnu::alias("fault")]] void SysTick_Handler();
[[gnu::weak, gnu::alias("fault")]] void bench_interrupt();  // interrupt 0

struct Vectors {
  const std::uint32_t* stack;
  Handler handlers[16];
};

[[gnu::section(".vectors.0"), gnu::used,
  gnu::aligned(256)]] extern const Vectors robosync_vectors = {
    &stack_top,
    {reset, fault, HardFault_Handler, MemManage_Handler, BusFault_Handler, UsageFault_Handler,
     fault, fault, fault, fault, SVC_Handler, fault, fault, PendSV_Handler, SysTick_Handler,
     bench_interrupt}};
// In use while an unprivileged thread runs (port/cortex-m4/switch.S).
[[gnu::section(".vectors.1"), gnu::used,
  gnu::aligned(256)]] extern const Vectors robosync_unprivileged_vectors = {
    &stack_top,
    {reset, fault, HardFault_Handler, MemManage_Handler, BusFault_Handler, UsageFault_Handler,
     fault, fault, fault, fault, SVC_Handler, fault, fault, PendSV_Unprivileged_Handler,
     SysTick_Handler, bench_interrupt}};

void reset() {
  *reinterpret_cast<volatile std::uint32_t*>(0xE000ED88) |= 0xF00000;  // CPACR: enables the FPU
  // As in the board's reset: the kernel's interrupts are masked until it runs.
  *reinterpret_cast<volatile std::uint32_t*>(0xE000ED20) = 0xFFFF0000;  // SHPR3: SysTick, PendSV
  asm volatile("dsb\n\tisb\n\tmsr basepri, %0" ::"r"(0x40) : "memory");
  // … and timer 1, the clock that times threads and counts ticks, starts to count down.
  *reinterpret_cast<volatile std::uint32_t*>(0x40001008) = ~std::uint32_t{0};  // reload
  *reinterpret_cast<volatile std::uint32_t*>(0x40001004) = ~std::uint32_t{0};  // value
  *reinterpret_cast<volatile std::uint32_t*>(0x40001000) = 1;                  // control: on
  for (const Handler* init = init_array_begin; init != init_array_end; ++init)
    (*init)();
  main();
}

}  // extern "C"
