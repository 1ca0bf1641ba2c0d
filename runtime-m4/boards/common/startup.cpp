// From reset to main(): FPU, memory, constructors. No code here may use the FPU before it is on, or
// .data and .bss before they are set up.
#include <cstdint>

#include "runtime-m4/boards/common/reset.hpp"
#include "runtime-m4/boards/common/vectors.hpp"
#include "runtime-m4/port/cortex-m4/core.hpp"

extern "C" {

// From the linker script.
extern std::uint32_t data_start, data_end, data_image, bss_start, bss_end;
using Constructor = void (*)();
extern const Constructor init_array_start, init_array_end;

int main();
void __cxa_pure_virtual();  // NOLINT: the compiler asks for this name

void __cxa_pure_virtual() {
  asm volatile("udf #0");
}

// An interrupt that nobody enabled: memory or hardware is faulty.
void Unexpected_Handler() {
  robosync::link::Fault fault{};
  asm volatile("mrs %0, ipsr" : "=r"(fault.xpsr));
  robosync::boards::reset_after(fault);
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

}  // extern "C"
