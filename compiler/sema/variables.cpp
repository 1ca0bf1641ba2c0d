#include "compiler/sema/variables.hpp"

#include <algorithm>
#include <cmath>

namespace robosync::compiler {
namespace {

constexpr double kFadeOne = 2147483648.0;  // 2^31: vm::Variable::fade of a variable that stays
constexpr double kLeft = 0.05;             // part of the distance left after FADES … OVER
constexpr double kTick = vm::kFadeTickMs;  // a duration counts milliseconds, too

// 0 would mean that it does not fade at all.
std::uint32_t fade_factor(vm::Value over) {
  const double factor = std::round(kFadeOne * std::pow(kLeft, kTick / over));
  return static_cast<std::uint32_t>(std::clamp(factor, 1.0, kFadeOne - 1));
}

}  // namespace

void Variables::declare(Program& program) {
  for (VariableName& name : names_.variables()) {
    ProgramVariable result;
    result.name = name.name.text;
    result.kind = name.kind;
    result.labels = name.labels;
    if (const auto* node = std::get_if<const ast::Remember*>(&name.declared))
      declare(**node, name, result);
    if (const auto* node = std::get_if<const ast::State*>(&name.declared))
      declare(**node, name, result);
    if (const auto* node = std::get_if<const ast::Feeling*>(&name.declared))
      declare(**node, name, result);
    if (name.unit != nullptr) result.dimension = name.unit->dimension;
    program.variables.push_back(std::move(result));
  }
  for (VariableName& name : names_.variables())
    name.ready = name.kind != vm::VariableKind::band;
  for (VariableName& name : names_.variables())
    if (const auto* node = std::get_if<const ast::Check*>(&name.declared))
      declare(**node, name, program);
  for (VariableName& name : names_.variables())
    name.ready = true;
}

void Variables::declare(const ast::Remember& node, VariableName& name, ProgramVariable& result) {
  name.unit = &canonical_unit(vm::Dimension::number);
  name.unit_span = node.name.span;
  if (node.value == nullptr) return;
  const auto value = expressions_.constant(*node.value, "what a REMEMBER starts with");
  if (!value) return;
  result.initial = value->code.constant;
  if (value->is_bare()) return;
  name.unit = value->unit;
  name.unit_span = value->unit_span;
}

void Variables::declare(const ast::State& node, VariableName& name, ProgramVariable& result) {
  check_labels(node.labels);
  name.unit = &canonical_unit(vm::Dimension::number);
  result.min = 0;
  result.max = label_value(std::max<std::size_t>(node.labels.size(), 1) - 1);
}

void Variables::check_labels(const std::vector<ast::Name>& labels) {
  NameIndex known;
  for (std::size_t i = 0; i < labels.size(); ++i) {
    const ast::Name& label = labels[i];
    if (known.add(label.text, i) || label.text.empty()) continue;
    diagnostics_.report(Code::E0101, "the label `" + label.text + "` is given twice")
        .label(label.span)
        .label(labels[*known.find(label.text)].span, "first given here", false);
  }
}

// All its numbers are of one dimension: that of the first with a unit.
void Variables::declare(const ast::Feeling& node, VariableName& name, ProgramVariable& result) {
  name.unit = &canonical_unit(vm::Dimension::number);
  name.unit_span = node.name.span;
  if (!node.from || !node.to || !node.start) return;
  for (const auto* part : {&node.from, &node.to, &node.start}) {
    const auto value = expressions_.constant(**part, "the range of a FEELING");
    if (!value) return;
    if (value->is_bare()) continue;
    name.unit = value->unit;
    name.unit_span = value->unit_span;
    break;
  }
  const Wanted wanted{name.unit, node.name.text, name.unit_span};
  const auto from = expressions_.constant_amount(*node.from, wanted);
  const auto to = expressions_.constant_amount(*node.to, wanted);
  if (!from || !to) return;
  if (from->code.constant >= to->code.constant) {
    diagnostics_.report(Code::E0509, "a FEELING goes from the smaller number to the larger one")
        .label(node.to->span)
        .label(node.from->span, "not above this", false);
    return;
  }
  result.min = from->code.constant;
  result.max = to->code.constant;
  name.low = result.min;
  name.high = result.max;
  result.initial = inside(*node.start, wanted, result).value_or(result.min);
  if (node.fades_to && node.fades_over) fade(node, wanted, result);
}

void Variables::fade(const ast::Feeling& node, const Wanted& wanted, ProgramVariable& result) {
  const auto target = inside(*node.fades_to, wanted, result);
  const auto over = expressions_.constant_duration(*node.fades_over, "OVER");
  if (!target || !over) return;
  result.fades_to = *target;
  result.fade = fade_factor(*over);
}

std::optional<vm::Value> Variables::inside(const ast::Expr& expr, const Wanted& wanted,
                                           const ProgramVariable& feeling) {
  const auto value = expressions_.constant_amount(expr, wanted);
  if (!value) return std::nullopt;
  const vm::Value number = value->code.constant;
  if (number >= feeling.min && number <= feeling.max) return number;
  diagnostics_
      .report(Code::E0509, "`" + feeling.name + "` goes from " +
                               format_value(feeling.min, *wanted.unit) + " to " +
                               format_value(feeling.max, *wanted.unit))
      .label(expr.span, "outside of that");
  return std::nullopt;
}

}  // namespace robosync::compiler
