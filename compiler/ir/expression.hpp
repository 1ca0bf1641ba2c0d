// A number or a truth value as the compiler holds it: names resolved, units converted. Values are
// thousandths of the canonical unit.
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
  variable,  // Expression::index: its place in ir::Program::variables
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
  elapsed,  // the time since the first operand, a TIMER
  lasted,   // a truth: since the first operand, a TIMER, the second has gone by
  less,
  less_equal,
  greater,
  greater_equal,
  equal,
  not_equal,
  logical_not,
  logical_and,
  logical_or,
  // Time words. `constant` is the duration, of `changed` the least difference. They remember the
  // past: each stands for one timer, which is evaluated in every step.
  held,      // operand FOR
  counted,   // operand `index` TIMES WITHIN
  sequence,  // first operand THEN second operand WITHIN
  latch,     // first operand enters, second operand stays: MARGIN
  rose,      // operand becomes true
  changed    // the number CHANGES [BY]
};

// A number or a truth value. Operands: none, one or two, by its operation.
struct Expression {
  Operation operation = Operation::constant;
  vm::Value constant = 0;
  std::size_t index = 0;
  ChannelRef channel;
  std::vector<Expression> operands;
  Fact fact{};  // what the optimiser has proved of it, in this place
  // The same computation, whatever is known of it.
  bool operator==(const Expression& other) const;
};

// Is it a time word itself, whatever its operands are?
[[nodiscard]] bool is_time_word(Operation operation);
[[nodiscard]] bool is_comparison(Operation operation);
// The same comparison with its sides exchanged.
[[nodiscard]] Operation mirrored(Operation comparison);

// Of two values, as the robot does it, so that neither folding a constant nor judging a TEST can
// differ from what a program does. Of arithmetic, comparisons, AND and OR; of others kUnknown.
[[nodiscard]] vm::Value compute(Operation operation, vm::Value left, vm::Value right);

// Does it, or a part of it, change with time alone?
[[nodiscard]] bool reads_time(const Expression& expression);

// Does it, or a part of it, remember the past?
[[nodiscard]] bool has_time_word(const Expression& expression);

// Can it be left out, or evaluated once instead of twice? It draws no random number, remembers
// nothing, and divides by nothing that may be 0, of which the robot tells.
[[nodiscard]] bool is_pure(const Expression& expression);

}  // namespace robosync::compiler
