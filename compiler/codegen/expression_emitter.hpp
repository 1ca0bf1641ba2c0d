// Turns expressions into instructions.
//
// Registers form a stack: each part of an expression writes the register of its depth, and the operation above reads it. So every
// register is written before it is read, and none holds a value after the expression.
#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <vector>

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

  // The whole of a condition, ready for `ret`. If the program shares, equal parts are evaluated once: every part is evaluated,
  // whatever the values of the others.
  Cell condition(const Expression& expression);
  // Returns the cell with the value; `depth` registers are in use.
  Cell value(const Expression& expression, std::uint32_t depth = 0);
  // `target`: a local, or a variable that is written in place.
  void value_into(Cell target, const Expression& expression) {
    put_into(target, value(expression));
  }
  // `cell` holds the result of the last instruction.
  void put_into(Cell target, Cell cell);
  Cell constant(vm::Value value, std::uint32_t depth = 0);
  // The truth of "left <operation> right".
  Cell compare(Operation operation, Cell left, vm::Value right, std::uint32_t depth);
  // Jumps unless the comparison is true; returns the index of the jump. nullopt: it is not a comparison, or its constant is out
  // of reach.
  std::optional<std::size_t> jump_unless(const Expression& comparison);
  std::optional<std::size_t> jump_unless(Operation comparison, Cell left, vm::Value right);
  // `source`, clamped to the variable's min and max where it may be outside.
  Cell clamped(Cell source, const ir::Variable& variable, const ir::Set& set);

  // From now on, reads of the variable are clamped to its range: its cell holds the unbounded sum of RAISE and LOWER, which the
  // next step clamps once.
  void bound_reads(std::size_t variable) { bounded_.insert(variable); }

  [[nodiscard]] LocalCells& locals() { return locals_; }

private:
  struct Shared {
    const Expression* part = nullptr;
    Cell cell;  // a register below all others
    bool done = false;
  };

  void share(const Expression& expression, std::vector<const Expression*>& seen);
  Cell worked_out(const Expression& expression, std::uint32_t depth);
  Cell now(std::uint32_t depth);
  Cell unary(vm::Opcode opcode, const Expression& operand, std::uint32_t depth);
  Cell binary(vm::Opcode opcode, const Expression& left, const Expression& right,
              std::uint32_t depth, bool exchanged = false);
  std::optional<Cell> cheaper(const Expression& expression, std::uint32_t depth);
  Cell comparison(Operation operation, const Expression& left, const Expression& right,
                  std::uint32_t depth);
  Cell time_word(const Expression& expression, std::uint32_t depth);
  Cell watched(const Expression& expression);
  Cell limited(vm::Opcode opcode, Cell source, vm::Value limit, std::uint32_t depth);
  Cell variable(std::size_t place, std::uint32_t depth);

  Parts& parts_;
  CodeDraft& code_;
  TimeWords time_words_;
  LocalCells locals_;
  std::vector<Shared> shared_;
  std::set<std::size_t> bounded_;  // variables
};

}  // namespace robosync::compiler
