// Responses, part: their statements without blocks.
#include "compiler/codegen/response_emitter.hpp"

#include <algorithm>
#include <utility>

namespace robosync::compiler {

namespace {

// What RAISE and LOWER set.
Expression sum_of(const ProgramSet& set) {
  Expression before;
  before.operation = Operation::variable;
  before.index = set.variable;
  before.fact = set.before;
  Expression sum;
  sum.operation = Operation::add;
  sum.operands = {std::move(before), set.value};
  return sum;
}

// To `load`, these are truth values, which a variable must not hold.
bool looks_like_truth(vm::Value constant) {
  return constant == vm::kTrue || constant == vm::kFalse;
}

}  // namespace

bool needs_clamping(const ProgramSet& set) {
  return set.relative || set.value.operation != Operation::constant;
}

ResponseCode ResponseEmitter::emit(const ProgramBlock& statements) {
  block(statements);
  if (!statements.empty() && std::holds_alternative<ProgramCommand>(statements.back().node))
    code().end_with_command();
  else
    code().emit(Opcode::end);
  return std::move(response_);
}

void ResponseEmitter::block(const ProgramBlock& statements) {
  for (const ProgramStatement& one : statements)
    statement(one);
}

void ResponseEmitter::statement(const ProgramStatement& statement) {
  const ProgramStatement* const outer = current_;
  current_ = &statement;
  mark();
  std::visit([this](const auto& node) { emit(node); }, statement.node);
  current_ = outer;
}

void ResponseEmitter::emit(const ProgramCommand& command) {
  for (const ProgramArgument& one : command.arguments)
    argument(one.param, one.value);
  code().emit(Opcode::cmd, parts_.tables.target(command), parts_.tables.verb(command),
              parts_.tables.word(command));
  response_.actuators |= parts_.tables.mask_of(command.actuators);
}

void ResponseEmitter::argument(vm::Param param, const Expression& value) {
  const auto number = static_cast<std::uint32_t>(param);
  if (value.operation == Operation::constant)
    code().emit(Opcode::arg_k, number,
                static_cast<std::uint32_t>(parts_.pool.constant(value.constant)));
  else
    code().emit(Opcode::arg, number, expressions_.value(value));
}

void ResponseEmitter::emit(const ProgramLocal& local) {
  const Cell cell = parts_.frame.add_local();
  expressions_.value_into(cell, local.value);
  expressions_.locals()[local.number] = cell;
}

// What is set is clamped here, so that the response goes on with what all others will see.
void ResponseEmitter::emit(const ProgramSet& set) {
  const ProgramVariable& variable = parts_.program.variables[set.variable];
  const Cell target = parts_.frame.write(parts_.tables.variable(set.variable));
  bool in_place = set.in_place;
  Cell value;
  if (needs_clamping(set)) {
    value = expressions_.value(set.relative ? sum_of(set) : set.value);
    value = expressions_.clamped(value, variable, set);
  } else {
    const vm::Value constant = std::clamp(set.value.constant, variable.min, variable.max);
    value = expressions_.constant(constant);
    in_place = in_place && !looks_like_truth(constant);
  }
  if (in_place)
    expressions_.put_into(target, value);
  else
    code().emit(set.relative ? Opcode::shift : Opcode::set, target, value);
}

void ResponseEmitter::emit(const ProgramWait& wait) {
  code().emit(Opcode::wait, expressions_.value(wait.duration));
}

void ResponseEmitter::emit(const ProgramThen&) {
  code().emit(Opcode::wait_done);
}

void ResponseEmitter::emit(const ProgramLog& log) {
  for (std::size_t i = 0; i < log.values.size(); ++i)
    argument(static_cast<vm::Param>(i), log.values[i]);
  code().emit(Opcode::log, {}, parts_.strings.offset(log.text));
}

void ResponseEmitter::emit(const ProgramAlert& alert) {
  code().emit(Opcode::alert, {}, parts_.strings.offset(alert.text));
}

void ResponseEmitter::emit(const ProgramHalt& halt) {
  for (const std::uint8_t target : parts_.tables.targets(halt))
    code().emit(Opcode::halt, target);
  response_.actuators |= parts_.tables.mask_of(halt);
}

}  // namespace robosync::compiler
