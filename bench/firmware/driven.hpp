// For firmware that drives a whole runtime from inside, as nothing outside could do as exactly: a
// given image is activated, and a thread of the lowest rank, as the link has in the firmware, feeds
// it. So when that thread comes back from feeding, the step is over, and everything that came of it
// is done.
//
// The firmware defines robosync_kernel, the runtime, and start().
#pragma once

#include <cstddef>
#include <span>

#include "runtime-m4/boards/memory.hpp"
#include "runtime-m4/runtime.hpp"

namespace robosync::bench {

// The memory for programs that `board` says, where it says.
inline std::span<std::byte> arena_at(const policy::BoardMemory& board) {
  return {reinterpret_cast<std::byte*>(board.arena_begin), board.arena_bytes};
}

// Called by main(), before the kernel runs: start_driven() with its runtime.
bool start();

// Starts the runtime and the thread that drives it.
[[nodiscard]] bool start_driven(Runtime& runtime, void (*drive)(void*));

// Says why, and leaves, when the image is refused.
void check(const vm::Verdict& verdict);

}  // namespace robosync::bench
