// SET, RAISE, LOWER and SIGNAL.
#include "compiler/sema/statements.hpp"

namespace robosync::compiler {
namespace {

// The words of `SET mood TO very happy`, which the grammar reads as a value.
std::optional<ast::Name> label_of(const ast::Expr& expr) {
  const auto* operand = std::get_if<ast::Operand>(&expr.node);
  if (operand == nullptr) return std::nullopt;
  ast::Name label = operand->name;
  label.span = expr.span;
  if (operand->channel) label.text += " " + operand->channel->text;
  return label;
}

std::string_view why_not(vm::VariableKind kind) {
  return kind == vm::VariableKind::band ? "it follows what it is a CHECK of"
                                        : "a signal is sent with SIGNAL";
}

}  // namespace

// The variable that a statement may set; with `number`, one that it may calculate with.
VariableName* Statements::settable(const ast::Name& name, bool number) {
  if (name.text.empty()) return nullptr;
  VariableName* variable = names_.find_variable(name.text);
  if (expressions_.find_binding(name.text) != nullptr) {
    diagnostics_.report(Code::E0508, "`" + name.text + "` is a parameter, which cannot be set")
        .label(name.span);
    return nullptr;
  }
  if (variable == nullptr) {
    const std::string kind = names_.kind_of(name.text);
    if (!kind.empty()) {
      diagnostics_.report(Code::E0508, "`" + name.text + "` is " + kind + ", which cannot be set")
          .label(name.span)
          .helps("REMEMBER, STATE and FEELING can be set");
      return nullptr;
    }
    Diagnostic& d = diagnostics_.report(Code::E0501, "there is no variable `" + name.text + "`")
                        .label(name.span);
    if (diagnostics_.may_search(names_.variables().size()))
      suggest(d, name.span, name.text, names_.variable_names());
    if (d.help.empty()) d.helps("declare it at the top: `REMEMBER " + name.text + " = 0`");
    return nullptr;
  }
  const bool fixed =
      variable->kind == vm::VariableKind::band || variable->kind == vm::VariableKind::signal;
  if (fixed) {
    diagnostics_
        .report(Code::E0508,
                "`" + name.text + "` is " + names_.kind_of(name.text) + ", which cannot be set")
        .label(name.span)
        .helps(std::string(why_not(variable->kind)));
    return nullptr;
  }
  if (!number || variable->kind != vm::VariableKind::state) return variable;
  diagnostics_
      .report(Code::E0508, "`" + name.text + "` is a STATE, which does not count up and down")
      .label(name.span)
      .helps("write `SET " + name.text + " TO " + variable->labels.front() + "`");
  return nullptr;
}

// Only of what is known now; the robot keeps the rest inside.
bool Statements::in_range(const VariableName& variable, const Typed& value) {
  if (!value.is_constant()) return true;
  const vm::Value number = value.code.constant;
  if (number >= variable.low && number <= variable.high) return true;
  diagnostics_
      .report(Code::E0509, "`" + variable.name.text + "` goes from " +
                               format_value(variable.low, *variable.unit) + " to " +
                               format_value(variable.high, *variable.unit))
      .label(value.span, "outside of that")
      .label(variable.name.span, "its range", false);
  return false;
}

void Statements::add(const ast::Set& node, Span span, ProgramBlock& result) {
  VariableName* variable = settable(node.name, false);
  if (variable == nullptr || node.value == nullptr || !variable->ready) return;
  if (variable->kind == vm::VariableKind::state) return set_label(node, *variable, span, result);
  Typed value =
      expressions_.amount(*node.value, {variable->unit, node.name.text, variable->unit_span});
  if (!value.is_number() || !in_range(*variable, value)) return;
  put(ProgramSet{variable->index, std::move(value.code), false}, span, result);
}

void Statements::set_label(const ast::Set& node, const VariableName& variable, Span span,
                           ProgramBlock& result) {
  const auto label = label_of(*node.value);
  if (!label) {
    diagnostics_.report(Code::E0306, "`" + node.name.text + "` is a word, and this is not one")
        .label(node.value->span)
        .helps("it can be " + list_names(variable.labels, "or"));
    return;
  }
  const auto place = find_label(names_, variable.labels, *label, node.name.text, diagnostics_);
  if (place)
    put(ProgramSet{variable.index, make_constant_code(label_value(*place)), false}, span, result);
}

void Statements::add(const ast::Raise& node, Span span, ProgramBlock& result) {
  VariableName* variable = settable(node.name, true);
  if (variable == nullptr || node.by == nullptr || !variable->ready) return;
  Typed by = expressions_.amount(
      *node.by,
      {variable->unit, node.lower ? "LOWER … BY" : "RAISE … BY", variable->unit_span, true});
  if (!by.is_number()) return;
  if (node.lower && by.is_constant())
    by.code.constant = -by.code.constant;
  else if (node.lower)
    by.code = make_unary(Operation::negate, std::move(by.code));
  put(ProgramSet{variable->index, std::move(by.code), true}, span, result);
}

void Statements::add(const ast::Signal& node, Span span, ProgramBlock& result) {
  const VariableName* variable = names_.find_variable(node.name.text);
  const bool good = variable != nullptr && variable->kind == vm::VariableKind::signal;
  // Its first thousandth is as good as any: what counts is that it changes.
  if (good) put(ProgramSet{variable->index, make_constant_code(1), true}, span, result);
}

}  // namespace robosync::compiler
