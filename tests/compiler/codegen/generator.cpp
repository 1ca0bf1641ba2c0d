#include "tests/compiler/codegen/generator.hpp"

#include <utility>

namespace robosync::compiler::testing {
namespace {

constexpr std::size_t kPlain = 0, kRanged = 1, kSignal = 2, kTimer = 3;

template <typename Node>
ir::Statement made(Node node) {
  return {std::move(node), 0, {}};
}

}  // namespace

std::vector<ir::Variable> Generator::variables() {
  ir::Variable signal = plain("signal");
  signal.kind = vm::VariableKind::signal;
  ir::Variable timer = plain("timer");
  timer.kind = vm::VariableKind::timer;
  timer.dimension = vm::Dimension::duration;
  return {plain("plain", 1), ranged("ranged", -5, 5), signal, timer};
}

E Generator::number_expression(unsigned depth) {
  const unsigned leaf = below(depth == 0 ? 4 : 11);
  switch (leaf) {
    case 0:
      return number(static_cast<int>(below(9)) - 2.5);
    case 1:
      return channel(below(4));
    case 2:
      return variable(below(3));
    case 3:
      return locals_.empty() ? channel(0)
                             : local(locals_[below(static_cast<unsigned>(locals_.size()))]);
    case 4:
      return of(often(50) ? Operation::negate : Operation::absolute,
                {number_expression(depth - 1)});
    case 5:
      return of(Operation::elapsed, {variable(kTimer)});
    default:
      break;
  }
  constexpr Operation kOperations[] = {Operation::add,     Operation::subtract, Operation::multiply,
                                       Operation::divide,  Operation::modulo,   Operation::minimum,
                                       Operation::maximum, Operation::round,    Operation::random};
  const bool draws = taste_.chance && (taste_.surprise || !in_condition_);
  const Operation operation = kOperations[below(draws ? 9 : 8)];
  return of(operation, {number_expression(depth - 1), number_expression(depth - 1)});
}

E Generator::condition(unsigned depth) {
  if (taste_.time_words && depth > 0 && often(20)) return timed(depth - 1);
  switch (depth == 0 ? 3 : below(5)) {
    case 0:
      return of(Operation::logical_not, {condition(depth - 1)});
    case 1:
      return of(Operation::logical_and, {condition(depth - 1), condition(depth - 1)});
    case 2:
      return of(Operation::logical_or, {condition(depth - 1), condition(depth - 1)});
    default:
      break;
  }
  const auto operation = static_cast<Operation>(static_cast<unsigned>(Operation::less) + below(6));
  const bool outer = std::exchange(in_condition_, true);
  E made = often(10) ? of(Operation::lasted, {variable(kTimer), number_expression(1)})
                     : of(operation, {number_expression(2), number_expression(2)});
  in_condition_ = outer;
  return made;
}

E Generator::timed(unsigned depth) {
  // A local may be read by a rule of its own, too: it keeps its value.
  const double seconds = below(4) * 0.5;
  switch (below(6)) {
    case 0:
      return held(condition(depth), seconds);
    case 1:
      return time_word(Operation::counted, seconds, {condition(depth)}, 1 + below(vm::kMaxEdges));
    case 2:
      return time_word(Operation::sequence, seconds, {condition(depth), condition(depth)});
    case 3:
      return time_word(Operation::latch, 0, {condition(depth), condition(depth)});
    case 4:
      return time_word(Operation::rose, 0, {condition(depth)});
    default:
      return time_word(Operation::changed, seconds, {number_expression(2)});
  }
}

std::vector<ir::Argument> Generator::arguments() {
  std::vector<ir::Argument> arguments;
  for (const vm::Param param : {vm::Param::to, vm::Param::at, vm::Param::over})
    if (often(30)) arguments.push_back({param, number_expression(2)});
  return arguments;
}

ir::Statement Generator::simple() {
  switch (below(10)) {
    case 0:
      return made(ir::Set{kPlain, number_expression(2), often(50)});
    case 1:
      return made(ir::Set{kRanged, number_expression(2), often(50)});
    case 2:
      return made(ir::Set{kSignal, number(0.001), true});
    case 3:
      return made(ir::Wait{number_expression(1)});
    case 4:
      return made(ir::Then{});
    case 5:
      return made(ir::Log{false, "log {} {}", {number_expression(1), number_expression(1)}});
    case 6: {
      const E value = number_expression(2);
      locals_.push_back(next_local_);
      return made(ir::Local{next_local_++, value});
    }
    case 7:
      return made(ir::Log{true, "alert", {}});
    case 8:
      return made(ir::Set{kTimer, of(Operation::now, {}), false});
    default:
      return often(30) ? made(move_arms(arguments())) : made(move(below(3), arguments()));
  }
}

ir::Repeat Generator::repeat(unsigned depth) {
  ir::Repeat repeat;
  repeat.kind = static_cast<ir::RepeatKind>(below(3));
  const bool constant = often(50);
  if (repeat.kind == ir::RepeatKind::times)
    repeat.control = constant ? number(below(4) - 0.5) : number_expression(1);
  if (repeat.kind == ir::RepeatKind::while_) repeat.control = condition(2);
  const bool counts =
      repeat.kind == ir::RepeatKind::times && repeat.control.operation == Operation::constant;
  repeat.body = block(depth - 1);
  if (!counts) repeat.body.push_back(made(ir::Wait{number(0.01)}));
  return repeat;
}

ir::Statement Generator::compound(unsigned depth) {
  switch (below(4)) {
    case 0: {
      ir::If choice{condition(2), block(depth - 1), {}};
      if (often(60)) choice.else_block = block(depth - 1);
      return made(std::move(choice));
    }
    case 1:
      return made(repeat(depth));
    case 2: {
      ir::WaitUntil wait{condition(2), {}};
      if (often(60)) wait.within = number_expression(1);
      return made(std::move(wait));
    }
    default:
      break;
  }
  if (!taste_.chance) return simple();
  ir::Pick pick;
  for (unsigned i = 1 + below(4); i > 0; --i)
    pick.options.push_back({static_cast<vm::Value>(1 + below(2000)), block(depth - 1)});
  return made(std::move(pick));
}

ir::Statement Generator::statement(unsigned depth) {
  const std::uint16_t number = next_line_++;
  ir::Statement statement = depth > 0 && often(40) ? compound(depth) : simple();
  statement.line = number;
  statement.span = {0, number, number + 1U};
  return statement;
}

ir::Block Generator::block(unsigned depth) {
  const std::size_t scope = locals_.size();
  ir::Block block;
  for (unsigned i = below(4); i > 0; --i)
    block.push_back(statement(depth));
  locals_.resize(scope);
  return block;
}

ir::Block Generator::response() {
  locals_.clear();
  next_local_ = 0;
  ir::Block block;
  for (unsigned i = 1 + below(5); i > 0; --i)
    block.push_back(statement(taste_.depth));
  locals_.clear();
  return block;
}

ir::Rule Generator::rule() {
  ir::Rule rule;
  rule.kind = static_cast<vm::RuleKind>(below(5));
  if (rule.kind == vm::RuleKind::every)
    rule.condition = number_expression(2);
  else if (rule.kind != vm::RuleKind::start)
    rule.condition = condition(3);
  rule.then_response = response();
  if (rule.kind == vm::RuleKind::when_else) rule.else_response = response();
  if (rule.kind != vm::RuleKind::start) {
    rule.cooldown = often(30) ? 1000 : 0;
    rule.waiting = often(30) ? 2000 : 0;
    rule.restarting = often(20);
  }
  rule.line = next_line_++;
  return rule;
}

ir::Rule Generator::safety_rule() {
  ir::Rule rule;
  rule.kind = vm::RuleKind::safety;
  rule.condition = condition(3);
  rule.then_response.push_back(
      made(often(30) ? ir::Halt{true, {}, {}} : ir::Halt{false, {}, {below(3)}}));
  if (often(50)) rule.then_response.push_back(made(ir::Halt{false, 0, {0, 1}}));
  if (often(50)) rule.then_response.push_back(made(ir::Log{true, "stopped", {}}));
  if (often(50)) rule.then_response.push_back(made(ir::Set{kRanged, number_expression(2), false}));
  if (often(60)) rule.resume = condition(3);
  rule.line = next_line_++;
  return rule;
}

ir::Program Generator::program() {
  ir::Program program;
  program.variables = variables();
  for (unsigned i = below(3); i > 0; --i)
    program.safety.push_back(safety_rule());
  const auto behaviors = static_cast<std::int16_t>(1 + below(3));
  for (std::int16_t b = 0; b < behaviors; ++b) {
    ir::Behavior behavior;
    behavior.priority = static_cast<std::int16_t>(90 - b);
    if (often(70)) behavior.name = "behaviour" + std::to_string(b);
    for (unsigned i = 1 + below(3); i > 0; --i)
      behavior.rules.push_back(rule());
    program.behaviors.push_back(std::move(behavior));
  }
  return program;
}

}  // namespace robosync::compiler::testing
