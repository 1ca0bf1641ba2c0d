// Output of a bench firmware to scripts/bench: QEMU, started with -semihosting, prints it. A breakpoint with a number in r0
// requests a service.
#include <array>
#include <charconv>

#include "bench/firmware/mark.hpp"

namespace robosync::bench {
namespace {

constexpr unsigned kSysWrite0 = 0x04;
constexpr unsigned kSysExit = 0x18;
constexpr unsigned kApplicationExit = 0x20026;
constexpr unsigned kRunTimeError = 0x20023;

void ask_host(unsigned service, std::uintptr_t argument) {
  register unsigned operation asm("r0") = service;
  register std::uintptr_t parameter asm("r1") = argument;
  asm volatile("bkpt 0xAB" : "+r"(operation) : "r"(parameter) : "memory");
}

void write(const char* text) {
  ask_host(kSysWrite0, reinterpret_cast<std::uintptr_t>(text));
}

}  // namespace

void say(const char* what, std::span<const std::int32_t> numbers) {
  write(what);
  for (const std::int32_t number : numbers) {
    std::array<char, 16> text{' '};
    *std::to_chars(text.data() + 1, text.data() + text.size() - 1, number).ptr = '\0';
    write(text.data());
  }
  write("\n");
}

void leave(bool ok) {
  for (;;)
    ask_host(kSysExit, ok ? kApplicationExit : kRunTimeError);
}

}  // namespace robosync::bench
