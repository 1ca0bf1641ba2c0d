// Numbers and truth values in the compiler: names are resolved and units converted. Values are thousandths of the canonical unit.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "compiler/ir/fact.hpp"

namespace robosync::compiler {

struct ChannelRef {
  std::size_t sensor = 0;
  std::size_t channel = 0;  // of the sensor
  bool operator==(const ChannelRef&) const = default;
  bool operator<(const ChannelRef& other) const {
    return sensor != other.sensor ? sensor < other.sensor : channel < other.channel;
  }
};

enum class Operation : std::uint8_t {
  constant,
  input,     // a channel
  variable,  // Expression::index: its index in ir::Program::variables
  local,     // Expression::index: its number in the response (ir::Local)
  negate,
  add,
  subtract,
  multiply,
  divide,
  modulo,
  absolute,
  minimum,
  maximum,
  round,   // to a multiple of the second operand
  random,  // from the first operand to the second
  // A TIMER is a variable: the time of its last RESTART.
  now,      // that time, in a RESTART
  elapsed,  // the time since the first operand, a TIMER, was restarted
  lasted,   // a truth value: the second operand has passed since the first, a TIMER, was restarted
  less,
  less_equal,
  greater,
  greater_equal,
  equal,
  not_equal,
  logical_not,
  logical_and,
  logical_or,
  // Time words. `constant` is the duration; for `changed`, the least difference. They remember the past: each has its own timer,
  // which is evaluated in every step.
  held,      // operand FOR
  counted,   // operand `index` TIMES WITHIN
  sequence,  // first operand THEN second operand WITHIN
  latch,     // first operand enters, second operand stays: MARGIN
  rose,      // operand becomes true
  changed    // the number CHANGES [BY]
};

// A number or a truth value. It has none, one or two operands, depending on its operation.
struct Expression {
  Operation operation = Operation::constant;
  vm::Value constant = 0;
  std::size_t index = 0;
  ChannelRef channel;
  std::vector<Expression> operands;
  Fact fact{};  // what the optimiser has proved about it at this place
  // Compares the computations; facts do not count.
  bool operator==(const Expression& other) const;
};

// True if it is itself a time word; operands do not count.
[[nodiscard]] bool is_time_word(Operation operation);
[[nodiscard]] bool is_comparison(Operation operation);
// The same comparison with its operands exchanged.
[[nodiscard]] Operation mirrored(Operation comparison);

// Computes with the robot's arithmetic, so that constant folding and the checks of a TEST agree with the program. Supports
// arithmetic, comparisons, AND and OR; other operations give kUnknown.
[[nodiscard]] vm::Value compute(Operation operation, vm::Value left, vm::Value right);

// True if it, or a part of it, changes with time alone.
[[nodiscard]] bool reads_time(const Expression& expression);

// True if it, or a part of it, remembers the past.
[[nodiscard]] bool has_time_word(const Expression& expression);

// True if it may be left out, or evaluated once instead of twice: it draws no random number, remembers nothing, and divides by
// nothing that may be 0, which the robot would report.
[[nodiscard]] bool is_pure(const Expression& expression);

}  // namespace robosync::compiler
