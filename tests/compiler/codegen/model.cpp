#include "tests/compiler/codegen/model.hpp"

#include <algorithm>
#include <map>

#include "vm/arithmetic.hpp"

namespace robosync::compiler::testing {
namespace {

struct OutOfPauses {};

class Model {
public:
  Model(const std::vector<ProgramVariable>& variables, World& world, unsigned pauses,
        const std::function<void(World&)>& pass_time)
      : variables_(variables), world_(world), pauses_(pauses), pass_time_(pass_time) {}

  void run(const ProgramBlock& block) {
    for (const ProgramStatement& statement : block)
      std::visit([this](const auto& node) { run(node); }, statement.node);
  }

  Deeds deeds;

private:
  vm::Value value(const Expression& expression) const;
  vm::Value binary(Operation operation, vm::Value left, vm::Value right) const;
  void pause(std::uint32_t until);
  void run(const ProgramCommand& command);
  void run(const ProgramLocal& local) { locals_[local.number] = value(local.value); }
  void run(const ProgramSet& set);
  void run(const ProgramWait& wait) {
    pause(world_.now + static_cast<std::uint32_t>(std::max(value(wait.duration), 1)));
  }
  void run(const ProgramWaitUntil& wait);
  void run(const ProgramThen&) { pause(world_.now + 1); }
  void run(const ProgramIf& choice);
  void run(const ProgramRepeat& repeat);
  void run(const ProgramPick&) {}
  void run(const ProgramLog& log);
  void run(const ProgramAlert& alert) { deeds.push_back("alert " + alert.text); }
  void run(const ProgramHalt&) {}

  const std::vector<ProgramVariable>& variables_;
  World& world_;
  unsigned pauses_;
  const std::function<void(World&)>& pass_time_;
  std::map<std::size_t, vm::Value> locals_;
};

vm::Value Model::value(const Expression& expression) const {
  const auto& operands = expression.operands;
  switch (expression.operation) {
    case Operation::constant:
      return expression.constant;
    case Operation::input:
      return world_.channels[expression.channel.sensor + expression.channel.channel +
                             (expression.channel.sensor > 1 ? 1 : 0)];
    case Operation::variable:
      return world_.variables[expression.index];
    case Operation::local:
      return locals_.at(expression.index);
    case Operation::negate:
      return vm::negate(value(operands[0]));
    case Operation::logical_not:
      return vm::logical_not(value(operands[0]));
    case Operation::logical_and:
      return value(operands[0]) & value(operands[1]);
    case Operation::logical_or:
      return value(operands[0]) | value(operands[1]);
    default:
      return binary(expression.operation, value(operands[0]), value(operands[1]));
  }
}

vm::Value Model::binary(Operation operation, vm::Value left, vm::Value right) const {
  if (left == vm::kUnknown || right == vm::kUnknown) return vm::kUnknown;
  switch (operation) {
    case Operation::add:
      return vm::add(left, right);
    case Operation::subtract:
      return vm::subtract(left, right);
    case Operation::multiply:
      return vm::multiply(left, right);
    case Operation::divide:
      return vm::divide(left, right);
    case Operation::modulo:
      return vm::modulo(left, right);
    case Operation::less:
      return vm::truth(left < right);
    case Operation::less_equal:
      return vm::truth(left <= right);
    case Operation::greater:
      return vm::truth(left > right);
    case Operation::greater_equal:
      return vm::truth(left >= right);
    case Operation::equal:
      return vm::truth(left == right);
    default:
      return vm::truth(left != right);
  }
}

void Model::pause(std::uint32_t until) {
  if (pauses_-- == 0) throw OutOfPauses{};
  world_.now = until;
  pass_time_(world_);
}

void Model::run(const ProgramCommand& command) {
  constexpr const char* kNames[] = {"left", "right", "sound"};
  std::map<vm::Param, vm::Value> params;
  for (const ProgramArgument& argument : command.arguments)
    params[argument.param] = value(argument.value);
  std::string deed = command.group ? "arms" : kNames[command.actuators[0]];
  for (const auto& [param, given] : params)
    deed += " " + std::to_string(static_cast<int>(param)) + ":" + std::to_string(given);
  deeds.push_back(deed);
}

void Model::run(const ProgramLog& log) {
  std::string deed = "log " + log.text;
  for (std::size_t i = 0; i < log.values.size(); ++i)
    deed += " " + std::to_string(i) + ":" + std::to_string(value(log.values[i]));
  deeds.push_back(deed);
}

void Model::run(const ProgramSet& set) {
  const ProgramVariable& variable = variables_[set.variable];
  vm::Value& place = world_.variables[set.variable];
  vm::Value wanted = value(set.value);
  if (set.relative) wanted = vm::add(place, wanted);
  if (wanted != vm::kUnknown) place = std::clamp(wanted, variable.min, variable.max);
}

void Model::run(const ProgramWaitUntil& wait) {
  std::uint32_t deadline = 0;
  if (wait.within)
    deadline = world_.now + static_cast<std::uint32_t>(std::max(value(*wait.within), 0));
  do
    pause(world_.now + 1);
  while (value(wait.condition) != vm::kTrue && !(wait.within && world_.now >= deadline));
}

void Model::run(const ProgramIf& choice) {
  const vm::Value truth = value(choice.condition);
  if (truth == vm::kTrue) run(choice.then_block);
  if (truth == vm::kFalse) run(choice.else_block);
}

void Model::run(const ProgramRepeat& repeat) {
  if (repeat.kind == RepeatKind::times) {
    for (std::int64_t left = value(repeat.control); left > 0; left -= vm::kScale)
      run(repeat.body);
    return;
  }
  while (repeat.kind == RepeatKind::forever || value(repeat.control) == vm::kTrue)
    run(repeat.body);
}

}  // namespace

Deeds expected_deeds(const ProgramBlock& block, const std::vector<ProgramVariable>& variables,
                     World& world, unsigned pauses, const std::function<void(World&)>& pass_time) {
  Model model(variables, world, pauses, pass_time);
  try {
    model.run(block);
  } catch (const OutOfPauses&) {
  }
  return std::move(model.deeds);
}

}  // namespace robosync::compiler::testing
