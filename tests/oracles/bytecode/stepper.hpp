// Runs code one instruction at a time, as instruction.hpp says, and holds every instruction against
// opcodes.def before it runs: that it may stand there, and that each operand is one that exists, was
// written before, and is of its type. Counts what the instructions are declared to cost.
//
// This is a second opinion about what the verifier proves once for all ways through the code, taken
// on the way that is run, and about what the interpreter does. It shares nothing with either but the
// list of opcodes.
#pragma once

#include <bitset>

#include "tests/fuzz/exercise.hpp"
#include "tests/support/operands.hpp"

namespace robosync::fuzz {

class Stepper {
public:
  // Calls engine.fail() for what is wrong. A run that costs more than `limit` is.
  Stepper(const vm::Image& image, std::uint32_t limit, Engine& engine)
      : image_(image), limit_(limit), engine_(engine) {}

  vm::Value evaluate(vm::Machine& machine, const CodeObject& object, std::uint32_t& cost);
  Run respond(vm::Machine& machine, const CodeObject& object, std::size_t from);

private:
  using Cells = std::bitset<256>;

  void begin(vm::Machine& machine, const CodeObject& object);
  void check(std::size_t at);
  void check_operand(std::size_t at, Word word, std::size_t place);
  void check_constant(Operand kind, std::size_t index);
  void check_read(unsigned cell, bool truth);
  void check_write(Word word, unsigned cell);
  void check_distance(std::size_t at, Word word, std::size_t place);
  void learn(Word word);
  [[nodiscard]] static std::size_t target_of(std::size_t at, Word word);
  void require(bool holds, const char* what) {
    if (!holds) engine_.fail(what);
  }

  const vm::Image& image_;
  std::uint32_t limit_;
  Engine& engine_;

  vm::Machine* machine_ = nullptr;
  const CodeObject* object_ = nullptr;
  std::size_t inputs_ = 0, locals_end_ = 0, first_register_ = 0, cells_ = 0;
  std::uint32_t owned_ = 0;  // variables that were set in this run
  std::uint32_t cost_ = 0;
  Cells known_, truths_;
};

}  // namespace robosync::fuzz
