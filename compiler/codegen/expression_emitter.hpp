// Numbers and truth values to instructions.
//
// Registers are a stack: a part of an expression writes the register of its depth, and the
// operation above reads it. So every register is written before it is read, and nothing stays in
// one.
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

  // The whole of a condition, ready for `ret`. When the program shares, parts of it that are equal
  // are worked out once: every part is evaluated whatever the others are.
  Cell condition(const Expression& expression);
  // Gives the cell where the value is; `depth` registers are in use.
  Cell value(const Expression& expression, std::uint32_t depth = 0);
  // `target`: a local, or a variable that is written in place.
  void value_into(Cell target, const Expression& expression) {
    put_into(target, value(expression));
  }
  // `cell` is what was worked out last.
  void put_into(Cell target, Cell cell);
  Cell constant(vm::Value value, std::uint32_t depth = 0);
  // The truth of "left <operation> right".
  Cell compare(Operation operation, Cell left, vm::Value right, std::uint32_t depth);
  // Jumps unless the comparison is true; gives the place of the jump. Nothing: it is no comparison,
  // or its constant stands too far behind.
  std::optional<std::size_t> jump_unless(const Expression& comparison);
  std::optional<std::size_t> jump_unless(Operation comparison, Cell left, vm::Value right);
  // `source`, but not outside min … max of the variable, as far as that has to be looked after.
  Cell clamped(Cell source, const ir::Variable& variable, const ir::Set& set);

  // From now on a read of the variable gives what is inside its range: its cell holds the sum of what
  // was raised and lowered, which the next step bounds once.
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
