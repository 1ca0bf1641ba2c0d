// All that SAFETY's bytecode writes, in one place. It runs unprivileged (port::Sandbox), and besides the workspace this is
// the only memory that it may write. The safety thread treats its contents like the workspace:
// no number is used as an index or an address before it is checked.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "runtime-m4/layers/memory.hpp"
#include "vm/interpreter.hpp"

namespace robosync::layers {

struct SafetyRegion {
  struct Work {
    vm::Machine machine;
    vm::Progress progress;
    vm::Params params;  // of its output, while that is read
  };

  // Allocates it for a program, right behind the stacks of its threads, all of which are multiples of policy::kStackUnit.
  // Empty if the program has no SAFETY rules.
  static SafetyRegion take(Memory& memory);

  // The words up to `end`, which the machine reports; none if `end` is not in `output`.
  static std::span<const vm::Word> put_out(std::span<const vm::Word> output, const vm::Word* end);

  std::span<std::byte> window;  // all of it, and nothing more
  std::byte* stack_top = nullptr;
  Work* work = nullptr;
  std::span<vm::Word> output;
  std::span<std::uint32_t> timer_words;
  std::span<std::uint32_t> cells;
};

}  // namespace robosync::layers
