// Shared by all bench firmware: places in the code that the counting plugin (bench/count_plugin) knows by their symbols, and a
// way to print results.
#pragma once

#include <cstdint>
#include <span>

// Defines the symbol mark_NAME at this place; costs no instruction. Each name may be used once.
#define BENCH_MARK(name) asm volatile(".global mark_" #name "\nmark_" #name ":" ::: "memory")

namespace robosync::bench {

// Prints a line: what, then the numbers. Not between markers, because it takes instructions.
void say(const char* what, std::span<const std::int32_t> numbers);

// Ends QEMU (semihosting SYS_EXIT). Exit code 0: everything was measured.
[[noreturn]] void leave(bool ok);

}  // namespace robosync::bench
