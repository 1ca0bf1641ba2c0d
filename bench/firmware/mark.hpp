// What every bench firmware has: places in the code that the counting plugin (bench/count_plugin)
// knows by their symbols, and a way to say what came out.
#pragma once

#include <cstdint>
#include <span>

// The symbol mark_NAME at this place; costs no instruction. Each name may stand once.
#define BENCH_MARK(name) asm volatile(".global mark_" #name "\nmark_" #name ":" ::: "memory")

namespace robosync::bench {

// Prints a line: what, then the numbers. Not between markers: it takes instructions.
void say(const char* what, std::span<const std::int32_t> numbers);

// Ends QEMU (semihosting SYS_EXIT). Code 0: everything was measured.
[[noreturn]] void leave(bool ok);

}  // namespace robosync::bench
