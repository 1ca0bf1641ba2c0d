// Ends a bench firmware: QEMU is started with -semihosting.
#include "bench/firmware/mark.hpp"

namespace robosync::bench {

void leave(bool ok) {
  constexpr unsigned kSysExit = 0x18;
  constexpr unsigned kApplicationExit = 0x20026;
  constexpr unsigned kRunTimeError = 0x20023;
  register unsigned operation asm("r0") = kSysExit;
  register unsigned reason asm("r1") = ok ? kApplicationExit : kRunTimeError;
  for (;;)
    asm volatile("bkpt 0xAB" : : "r"(operation), "r"(reason) : "memory");
}

}  // namespace robosync::bench
