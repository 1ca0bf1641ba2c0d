// What one instruction does, said naively from its line in vm/opcodes.def: with the arithmetic of
// tests/oracles/rsl/values.hpp, and none of the interpreter's code.
//
// Time words are the exception. Their memory may hold anything, which is a matter of how they are
// built; tests/vm/timers_test.cpp compares them with what they mean.
#pragma once

#include "vm/interpreter.hpp"

namespace robosync::oracle {

enum class Went : std::uint8_t { on, to_target, paused, ended };

struct Done {
  Went went = Went::on;
  vm::Value result = vm::kUnknown;  // of what ends a condition
  vm::Pause pause = vm::Pause::ended;
  std::uint32_t wake = vm::Machine::kNever;
  bool pauses_at_target = false;  // where it goes on: there, or behind the instruction
};

// Runs the instruction `word` on `machine`, whose members are its memory. An opcode that nobody has
// said anything about here throws std::logic_error.
[[nodiscard]] Done run(vm::Machine& machine, vm::Word word);

}  // namespace robosync::oracle
