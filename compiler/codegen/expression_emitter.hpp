// Numbers and truth values to instructions.
//
// Registers are a stack: a part of an expression writes the register of its depth, and the
// operation above reads it. So every register is written before it is read, and nothing stays in
// one.
#pragma once

#include "compiler/codegen/parts.hpp"

namespace robosync::compiler {

enum class TimeWords : std::uint8_t {
  evaluated,  // in a condition: each is an instruction with a timer
  watched     // in a response: each is the truth of a watch rule
};

class ExpressionEmitter {
public:
  ExpressionEmitter(Parts& parts, CodeDraft& code, TimeWords time_words)
      : parts_(parts), code_(code), time_words_(time_words) {}

  // Gives the cell where the value is; `depth` registers are in use.
  Cell value(const Expression& expression, std::uint32_t depth = 0);
  void value_into(Cell local, const Expression& expression);
  Cell constant(vm::Value value, std::uint32_t depth = 0);
  // The truth of "left <operation> right".
  Cell compare(Operation operation, Cell left, vm::Value right, std::uint32_t depth);
  // `source`, but not outside min … max of the variable.
  Cell clamped(Cell source, const ProgramVariable& variable);

  [[nodiscard]] LocalCells& locals() { return locals_; }

private:
  Cell unary(vm::Opcode opcode, const Expression& operand, std::uint32_t depth);
  Cell binary(vm::Opcode opcode, const Expression& left, const Expression& right,
              std::uint32_t depth);
  Cell comparison(Operation operation, const Expression& left, const Expression& right,
                  std::uint32_t depth);
  Cell time_word(const Expression& expression, std::uint32_t depth);
  Cell watched(const Expression& expression);
  Cell limited(vm::Opcode opcode, Cell source, vm::Value limit);

  Parts& parts_;
  CodeDraft& code_;
  TimeWords time_words_;
  LocalCells locals_;
};

}  // namespace robosync::compiler
