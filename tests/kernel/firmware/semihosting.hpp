// The debugger's console and exit, which QEMU offers with -semihosting.
#pragma once

#include <cstdint>

namespace semihosting {

inline std::uint32_t call(std::uint32_t operation, const void* argument) {
  register std::uint32_t r0 asm("r0") = operation;
  register const void* r1 asm("r1") = argument;
  asm volatile("bkpt 0xAB" : "+r"(r0) : "r"(r1) : "memory");
  return r0;
}

inline void print(const char* text) {
  call(0x04, text);
}

[[noreturn]] inline void exit(std::uint32_t code) {
  const std::uint32_t block[] = {0x20026, code};  // application exit
  call(0x20, block);
  while (true) {
  }
}

}  // namespace semihosting
