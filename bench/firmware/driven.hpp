// For firmware that drives a whole runtime from inside, more exactly than anything outside could. It activates a given image. A
// thread of the lowest rank, like the link's in the firmware, feeds the runtime: when a call that feeds it returns, the step and
// all its consequences are complete.
//
// The firmware defines robosync_kernel, the runtime, and start().
#pragma once

#include <cstddef>
#include <span>

#include "runtime-m4/boards/memory.hpp"
#include "runtime-m4/runtime.hpp"

namespace robosync::bench {

// The memory for programs that `board` specifies.
inline std::span<std::byte> arena_at(const policy::BoardMemory& board) {
  return {reinterpret_cast<std::byte*>(board.arena_begin), board.arena_bytes};
}

// main() calls it before the kernel runs; it calls start_driven() with its runtime.
bool start();

// Starts the runtime and the thread that drives it.
[[nodiscard]] bool start_driven(Runtime& runtime, void (*drive)(void*));

// If the image was refused, prints why and exits.
void check(const vm::Verdict& verdict);

}  // namespace robosync::bench
