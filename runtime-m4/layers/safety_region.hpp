// All that SAFETY's bytecode writes, in one place: it runs without privileges (port::Sandbox), and this is the only
// memory that it may write besides the workspace. The safety thread reads what stands here as it reads the workspace:
// no number of it is an index or an address until it is checked.
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
  };

  // For a program, right behind the stacks of its threads, all of which are multiples of policy::kStackUnit. Empty when
  // it has no SAFETY rules.
  static SafetyRegion take(Memory& memory);

  // The words that `end`, the machine's, says were put out; none of them where it is not in `output`.
  static std::span<const vm::Word> put_out(std::span<const vm::Word> output, const vm::Word* end);

  std::span<std::byte> window;  // all of it, and nothing else
  std::byte* stack_top = nullptr;
  Work* work = nullptr;
  std::span<vm::Word> output;
  std::span<std::uint32_t> timer_words;
  std::span<std::uint32_t> cells;
};

}  // namespace robosync::layers
