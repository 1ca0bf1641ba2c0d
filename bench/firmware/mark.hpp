// Places in the code that the counting plugin (bench/count_plugin) knows by their symbols.
#pragma once

// The symbol mark_NAME at this place; costs no instruction. Each name may stand once.
#define BENCH_MARK(name) asm volatile(".global mark_" #name "\nmark_" #name ":" ::: "memory")

namespace robosync::bench {

// Ends QEMU (semihosting SYS_EXIT). Code 0: everything was measured.
[[noreturn]] void leave(bool ok);

}  // namespace robosync::bench
