#include "compiler/sema/expressions.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "compiler/config/values.hpp"
#include "compiler/sema/lints.hpp"

namespace robosync::compiler {
namespace {

constexpr std::size_t kMaxNestedLets = 64;  // of LETs: the translation recurses

}  // namespace

Typed Expressions::any(const ast::Expr& expr) {
  return std::visit([&](const auto& node) { return of(node, expr.span); }, expr.node);
}

Typed Expressions::condition(const ast::Expr& expr) {
  Typed result = any(expr);
  if (result.type == Type::word) {
    if (result.truth)
      return make_condition(
          make_binary(Operation::equal, std::move(result.code), make_constant_code(label_value(1))),
          expr.span);
    report_word(result, "a condition", diagnostics_);
    return make_nothing(expr.span);
  }
  if (!result.is_number()) return result;
  Diagnostic& d =
      diagnostics_.report(Code::E0302, "this is a number, not a condition").label(expr.span);
  if (!result.source.empty()) d.helps("compare it, for example `" + result.source + " > 0`");
  return make_nothing(expr.span);
}

Typed Expressions::number(const ast::Expr& expr) {
  return number_of(any(expr));
}

Typed Expressions::number_of(Typed result) {
  if (result.type == Type::word) {
    report_word(result, "a number", diagnostics_);
    return make_nothing(result.span);
  }
  if (result.type != Type::condition) return result;
  diagnostics_.report(Code::E0302, "this is a condition, and a number is needed here")
      .label(result.span);
  return make_nothing(result.span);
}

Typed Expressions::of(const ast::Quantity& node, Span span) {
  const Unit* unit = find_unit(node.unit);
  if (unit == nullptr) {
    suggest_unit(diagnostics_.report(Code::E0303, "there is no unit `" + node.unit + "`")
                     .label(node.unit_span),
                 node.unit);
    return make_nothing(span);
  }
  if (node.digits.empty()) return make_nothing(span);
  const auto decimal = parse_decimal(node.digits);
  const auto value = decimal ? to_value(*decimal, *unit) : std::nullopt;
  if (!value) {
    diagnostics_
        .report(Code::E0304, decimal ? "this number is too large for the robot"
                                     : "this number has too many digits for the robot")
        .label(span)
        .helps("numbers on the robot are thousandths, from -2147483 to 2147483");
    return make_nothing(span);
  }
  Typed result = make_constant(*value, *unit, span);
  result.unit_span = node.unit_span;
  result.digits = node.digits;
  result.bare = *decimal;
  if (node.unit.empty()) {
    result.unit = nullptr;
    result.unit_span = span;
  }
  return result;
}

// The innermost meaning: a parameter, then what the program names, then the sensors.
Typed Expressions::operand(const ast::Operand& operand, Span span) {
  if (!operand.channel) {
    if (const Binding* binding = find_binding(operand.name.text))
      return parameter(*binding, operand, span);
    if (ConstantName* name = names_.find_constant(operand.name.text))
      return constant(*name, operand, span);
    if (VariableName* name = names_.find_variable(operand.name.text)) return variable(*name, span);
  }
  const auto ref = names_.find_channel(operand);
  return ref ? channel(*ref, span) : make_nothing(span);
}

const Bindings* Expressions::set_bindings(const Bindings* bindings) {
  return std::exchange(bindings_, bindings);
}

const Binding* Expressions::find_binding(std::string_view name) const {
  if (bindings_ == nullptr) return nullptr;
  const std::string folded = fold_name(name);
  const auto found = std::find_if(bindings_->begin(), bindings_->end(),
                                  [&](const Binding& binding) { return binding.name == folded; });
  return found == bindings_->end() ? nullptr : &*found;
}

Typed Expressions::parameter(const Binding& binding, const ast::Operand& operand, Span span) {
  if (binding.text) {
    diagnostics_
        .report(Code::E0306, "`" + operand.name.text + "` is given a text, and a number is needed")
        .label(span)
        .label(binding.span, "given here", false);
    return make_nothing(span);
  }
  return binding.value;  // with its place where it is given, which is where a mistake is mended
}

Typed Expressions::channel(ChannelRef ref, Span span) {
  const ChannelConfig& config = names_.channel(ref);
  Typed result;
  result.type = Type::number;
  result.code.operation = Operation::input;
  result.code.channel = ref;
  result.span = span;
  result.unit = config.unit;
  result.unit_span = config.unit_span;
  result.source = names_.channel_name(ref);
  result.low = config.min;
  result.high = config.max;
  if (config.labels.empty()) return result;
  result.type = Type::word;
  result.labels = &config.labels;
  result.truth = config.truth;
  return result;
}

Typed Expressions::variable(VariableName& name, Span span) {
  Expression code;
  code.operation = Operation::variable;
  code.index = name.index;
  if (name.kind == vm::VariableKind::signal)
    return make_condition(make_unary(Operation::changed, std::move(code)), span);
  if (!name.ready) {
    diagnostics_
        .report(Code::E0305, "`" + name.name.text + "` changes while the program runs, and this " +
                                 "must be known before")
        .label(span);
    return make_nothing(span);
  }
  Typed result;
  result.type = name.labels.empty() ? Type::number : Type::word;
  result.code = std::move(code);
  result.span = span;
  result.unit = name.unit;
  result.unit_span = name.unit_span;
  result.source = name.name.text;
  result.low = name.low;
  result.high = name.high;
  if (!name.labels.empty()) result.labels = &name.labels;
  return result;
}

Typed Expressions::constant(ConstantName& name, const ast::Operand& operand, Span span) {
  if (std::find(open_.begin(), open_.end(), name.let) != open_.end()) {
    diagnostics_.report(Code::E0402, "the value of `" + operand.name.text + "` depends on itself")
        .label(span);
    return make_nothing(span);
  }
  name.used = true;
  if (open_.size() == kMaxNestedLets) {
    diagnostics_.report(Code::E0407, "LETs use each other more than 64 levels deep").label(span);
    return make_nothing(span);
  }
  Typed result = value_of(name);
  result.span = span;
  result.digits.clear();
  return result;
}

const Typed& Expressions::value_of(ConstantName& name) {
  const auto known = constants_.find(name.let);
  if (known != constants_.end()) return known->second;
  Typed result = make_nothing(name.let->name.span);
  if (name.let->value) {
    open_.push_back(name.let);
    result = number(*name.let->value);
    open_.pop_back();
    if (result.is_number() && !result.is_constant()) {
      diagnostics_.report(Code::E0305, "the value of a LET must be known before the program runs")
          .label(name.let->value->span);
      result = make_nothing(result.span);
    }
  }
  return constants_.emplace(name.let, std::move(result)).first->second;
}

void Expressions::check_constants() {
  for (const auto& [folded, constant] : names_.constants())
    value_of(*names_.find_constant(folded));
}

Typed Expressions::of(const ast::Comparison& node, Span span) {
  Typed left = any(*node.left);
  if (left.type == Type::word) {
    report_word_comparison(node, left);
    return make_nothing(span);
  }
  if (left.type == Type::condition) left = number(*node.left);  // which says what is wrong
  Typed right = number(*node.right);
  if (!left.is_number() || !right.is_number()) return make_nothing(span);
  if (!unify(left, right, "this compares {} with {}", false, diagnostics_))
    return make_nothing(span);
  lint_comparison(node.relation, left, right, span, diagnostics_);
  return make_condition(compare(node.relation, std::move(left), std::move(right)), span);
}

Typed Expressions::of(const ast::Not& node, Span span) {
  Typed inner = condition(*node.value);
  if (inner.type != Type::condition) return make_nothing(span);
  return make_condition(make_unary(Operation::logical_not, std::move(inner.code)), span);
}

Typed Expressions::of(const ast::Logic& node, Span span) {
  Typed left = condition(*node.left);
  Typed right = condition(*node.right);
  if (left.type != Type::condition || right.type != Type::condition) return make_nothing(span);
  const auto operation =
      node.op == ast::LogicOp::and_ ? Operation::logical_and : Operation::logical_or;
  return make_condition(make_binary(operation, std::move(left.code), std::move(right.code)), span);
}

}  // namespace robosync::compiler
