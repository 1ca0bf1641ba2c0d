#include "compiler/sema/expressions.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "compiler/config/values.hpp"
#include "compiler/ir/expression.hpp"
#include "compiler/sema/condition_lints.hpp"

namespace robosync::compiler {
namespace {

constexpr std::size_t kMaxNestedLets = 64;  // the translation recurses

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
  Typed result = any(expr);
  if (result.type == Type::word || result.type == Type::condition)
    result = number_of(std::move(result));
  return result;
}

Typed Expressions::number_of(Typed result) {
  if (result.type == Type::word) {
    report_word(result, "a number", diagnostics_);
    return make_nothing(result.span);
  }
  if (result.type != Type::condition) return result;
  diagnostics_.report(Code::E0302, "this is a condition, but a number is needed here")
      .label(result.span);
  return make_nothing(result.span);
}

Typed Expressions::of(const ast::Quantity& node, Span span) {
  const Unit* unit = find_unit(node.unit);
  if (unit == nullptr) {
    suggest_unit(
        diagnostics_.report(Code::E0303, "there is no unit `" + std::string(node.unit) + "`")
            .label(node.unit_span),
        node.unit);
    return make_nothing(span);
  }
  if (node.digits.empty()) return make_nothing(span);
  const auto decimal = parse_decimal(node.digits);
  const auto value = decimal ? to_value(*decimal, *unit) : std::nullopt;
  if (!value) {
    const std::string number = std::string(node.digits) + std::string(node.unit);
    diagnostics_
        .report(Code::E0304, decimal ? no_room_for(number, *unit) : too_many_digits(node.digits))
        .label(span);
    return make_nothing(span);
  }
  if (!node.unit.empty()) note_rounded(*decimal, *value, *unit, span, diagnostics_);
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

// Resolves the innermost meaning: a parameter, then a name of the program, then a sensor.
Typed Expressions::operand(const ast::Operand& operand, Span span) {
  if (!operand.channel) {
    if (const Binding* binding = find_binding(operand.name.text))
      return parameter(*binding, operand, span);
    if (ConstantName* name = names_.find_constant(operand.name.text))
      return constant(*name, operand, span);
    if (VariableName* name = names_.find_variable(operand.name.text)) return variable(*name, span);
  }
  const ListName* list =
      names_.find_list(operand.channel ? operand.channel->text : operand.name.text);
  if (list != nullptr && !names_.find_sensor(operand.name.text)) {
    const bool chooses = operand.channel && !list->numbers;
    diagnostics_
        .report(Code::E0306, chooses
                                 ? "a text from a LIST cannot be used here"
                                 : list->list->name.shown() + " is a LIST, but a number is needed")
        .label(span)
        .label(list->list->name.span, "the LIST", false)
        .helps(chooses ? "a command or a LOG can choose one text: write one for each"
               : list->numbers
                   ? "say which number: `ITEM 1 OF " + std::string(list->list->name.text) + "`"
                   : "it holds texts; `COUNT OF " + std::string(list->list->name.text) +
                         "` is a number");
    return make_nothing(span);
  }
  const auto ref = names_.find_channel(operand);
  return ref ? channel(*ref, span) : make_nothing(span);
}

const Bindings* Expressions::set_bindings(const Bindings* bindings) {
  return std::exchange(bindings_, bindings);
}

bool Expressions::set_following(bool following) {
  lost_ = false;
  return std::exchange(following_, following);
}

bool Expressions::chooses_text(std::string_view word, std::string_view list) const {
  const ListName* const found = names_.find_list(list);
  return found != nullptr && !found->numbers && (same_name(word, "ANY") || same_name(word, "NEXT"));
}

const Binding* Expressions::find_binding(std::string_view name) const {
  if (bindings_ == nullptr) return nullptr;
  const std::string folded = fold_name(name);
  const auto found = std::find_if(bindings_->begin(), bindings_->end(),
                                  [&](const Binding& binding) { return binding.name == folded; });
  return found == bindings_->end() ? nullptr : &*found;
}

namespace {

std::string kind_of(const Binding& binding) {
  if (binding.text || binding.chosen) return "a text";
  if (!binding.actuator.empty()) return "the actuator `" + binding.actuator + "`";
  return binding.define != nullptr ? "a DEFINE" : "a number";
}

}  // namespace

void Expressions::report_given(const Binding& binding, const ast::Name& name,
                               std::string_view wanted) {
  diagnostics_
      .report(Code::E0306, name.shown() + " is given " + kind_of(binding) + ", but " +
                               std::string(wanted) + " is needed")
      .label(name.span)
      .label(binding.span, "given here", false);
}

Typed Expressions::parameter(const Binding& binding, const ast::Operand& operand, Span span) {
  if (!binding.is_number) {
    report_given(binding, {operand.name.text, span}, "a number");
    return make_nothing(span);
  }
  // Its span is that of the argument, where the user fixes a mistake.
  if (!following_ || binding.value.is_constant()) return binding.value;
  if (binding.followed.is_number()) return binding.followed;
  lost_ = lost_ || binding.value.is_number();
  return binding.value;
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
  if (name.taken) return make_nothing(span);
  Expression code;
  code.operation = Operation::variable;
  code.index = name.index;
  name.heard = true;
  if (name.kind == vm::VariableKind::signal)
    return make_condition(make_unary(Operation::changed, std::move(code)), span);
  if (!name.ready) {
    diagnostics_
        .report(Code::E0305, name.name.shown() + " changes while the program runs, but this " +
                                 "must be known beforehand")
        .label(span);
    return make_nothing(span);
  }
  Typed result;
  result.type = name.labels.empty() ? Type::number : Type::word;
  result.code = name.kind == vm::VariableKind::timer
                    ? make_unary(Operation::elapsed, std::move(code))
                    : std::move(code);
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
    diagnostics_.report(Code::E0402, "the value of " + operand.name.shown() + " depends on itself")
        .label(span);
    return make_nothing(span);
  }
  name.used = true;
  if (open_.size() == kMaxNestedLets) {
    diagnostics_
        .report(Code::E0407, "LETs use each other more than " + std::to_string(kMaxNestedLets) +
                                 " levels deep, the most that rsc allows")
        .label(span);
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
          .label(name.let->value->span)
          .helps("write this where you need it, or store it in a REMEMBER with `SET`");
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
  if (left.type == Type::condition) left = number(*node.left);  // reports the mistake
  Typed right = number(*node.right);
  if (!left.is_number() || !right.is_number()) return make_nothing(span);
  if (!unify(left, right, "this compares {} with {}", false, diagnostics_))
    return make_nothing(span);
  if (!is_given()) lint_comparison(node.relation, left, right, span, diagnostics_);
  if (reads_time(left.code) || reads_time(right.code))
    return time_comparison(node.relation, std::move(left), std::move(right), span);
  return make_condition(compare(node.relation, std::move(left), std::move(right)), span);
}

Typed Expressions::of(const ast::Not& node, Span span) {
  Typed inner = condition(*node.value);
  if (inner.type != Type::condition) return make_nothing(span);
  return make_condition(make_unary(Operation::logical_not, std::move(inner.code)), span);
}

Typed Expressions::of(const ast::Logic& node, Span span) {
  Typed left = condition(*node.left);
  if (left.type == Type::condition && asks_nothing(node)) return make_nothing(span);
  Typed right = condition(*node.right);
  if (left.type != Type::condition || right.type != Type::condition) return make_nothing(span);
  const auto operation =
      node.op == ast::LogicOp::and_ ? Operation::logical_and : Operation::logical_or;
  if (!is_given()) lint_logic(node.op, left.code, right.code, span, names_, diagnostics_);
  return make_condition(make_binary(operation, std::move(left.code), std::move(right.code)), span);
}

// ---- sums, products and RANDOM: units, ranges and constant folding

namespace {

constexpr unsigned kBareDecimals = 3;  // folded constants are thousandths

Operation operation_of(ast::ArithmeticOp op) {
  constexpr std::array kOperations = {Operation::add, Operation::subtract, Operation::multiply,
                                      Operation::divide, Operation::modulo};
  return kOperations[static_cast<std::size_t>(op)];
}

// The range of the result of an addition, subtraction or modulo.
void set_range(Typed& result, const Typed& left, const Typed& right) {
  const auto clamp = [](std::int64_t value) {
    return std::clamp<std::int64_t>(value, vm::kValueMin, vm::kValueMax);
  };
  if (result.code.operation == Operation::add) {
    result.low = clamp(left.low + right.low);
    result.high = clamp(left.high + right.high);
  } else if (result.code.operation == Operation::subtract) {
    result.low = clamp(left.low - right.high);
    result.high = clamp(left.high - right.low);
  }
}

}  // namespace

Typed Expressions::of(const ast::Negate& node, Span span) {
  Typed inner = number(*node.value);
  const bool is_literal = inner.is_number() && inner.is_constant() && !inner.digits.empty();
  if (!inner.is_number() || (!is_literal && report_point(inner, diagnostics_)))
    return make_nothing(span);
  if (is_point(inner)) return negative_point(std::move(inner), span);
  if (inner.is_constant()) {
    inner.code.constant = -inner.code.constant;
    inner.bare.mantissa = -inner.bare.mantissa;
    if (!inner.digits.empty()) inner.digits = "-" + inner.digits;
  } else {
    inner.code = make_unary(Operation::negate, std::move(inner.code));
  }
  inner.span = span;
  const std::int64_t low = inner.low;
  inner.low = -inner.high;
  inner.high = -low;
  return inner;
}

// `-5F` is one number, not the negative of 5F.
Typed Expressions::negative_point(Typed literal, Span span) {
  literal.span = span;
  literal.digits = "-" + literal.digits;
  literal.bare.mantissa = -literal.bare.mantissa;
  const auto value = to_value(literal.bare, *literal.unit);
  if (!value) {
    const std::string number = literal.digits + std::string(literal.unit->spelling);
    diagnostics_.report(Code::E0304, no_room_for(number, *literal.unit)).label(span);
    return make_nothing(span);
  }
  literal.code.constant = *value;
  literal.low = *value;
  literal.high = *value;
  return literal;
}

Typed Expressions::of(const ast::Arithmetic& node, Span span) {
  Typed left = number(*node.left);
  Typed right = number(*node.right);
  if (!left.is_number() || !right.is_number()) return make_nothing(span);
  const bool divides = node.op == ast::ArithmeticOp::div || node.op == ast::ArithmeticOp::mod;
  if (divides) check_divisor(right);
  const bool scales = node.op == ast::ArithmeticOp::mul || node.op == ast::ArithmeticOp::div;
  return scales ? product(node, std::move(left), std::move(right), span)
                : sum(node, std::move(left), std::move(right), span);
}

void Expressions::check_divisor(const Typed& divisor) {
  if (divisor.low > 0 || divisor.high < 0) return;
  if (divisor.code.operation == Operation::variable &&
      names_.variables()[divisor.code.index].fixed.value_or(0) != 0)
    return;
  const bool certain = divisor.is_constant();
  diagnostics_
      .report(Code::W0217, certain ? "this divides by zero, which gives 0"
                                   : "this can be zero, and a division by zero gives 0")
      .label(divisor.span);
}

// +, - and MOD: both sides have one dimension.
Typed Expressions::sum(const ast::Arithmetic& node, Typed left, Typed right, Span span) {
  constexpr std::array<std::string_view, 5> kDoing = {"this adds {} and {}",
                                                      "this takes the difference of {} and {}", "",
                                                      "", "this divides {} by {}"};
  const std::string_view doing = kDoing[static_cast<std::size_t>(node.op)];
  const bool subtracts = node.op == ast::ArithmeticOp::sub;
  const bool from_point = subtracts && left.is_bare() && is_point(right);
  if (!unify(left, right, doing, !from_point, diagnostics_)) return make_nothing(span);
  const Unit* unit = left.unit;
  if (node.op == ast::ArithmeticOp::mod) {
    if (report_points(left, right)) return make_nothing(span);
  } else if (is_point(left) || is_point(right) || is_difference(left) || is_difference(right)) {
    unit = unify_sum(left, right, subtracts, doing, diagnostics_);
    if (unit == nullptr) return make_nothing(span);
  }
  return combine(node.op, std::move(left), std::move(right), unit, span);
}

// MOD, * and /: reports a temperature in F. A literal may be a difference.
bool Expressions::report_points(const Typed& left, Typed& right) {
  if (is_difference(left)) make_difference(right);
  return report_point(left, diagnostics_) || report_point(right, diagnostics_);
}

// * and /: one side is a plain number, or both have one dimension and the quotient is plain.
Typed Expressions::product(const ast::Arithmetic& node, Typed left, Typed right, Span span) {
  if (report_points(left, right)) return make_nothing(span);
  const Unit& plain = canonical_unit(vm::Dimension::number);
  const bool divides = node.op == ast::ArithmeticOp::div;
  const bool left_plain = left.dimension() == vm::Dimension::number;
  const bool right_plain = right.dimension() == vm::Dimension::number;
  const Unit* unit = right_plain ? left.unit : right.unit;
  if (left_plain && right_plain && unit == nullptr && !(left.is_bare() && right.is_bare()))
    unit = &plain;
  if (divides && !right_plain) {
    if (left.dimension() != right.dimension()) {
      report_mismatch(left, right, "this divides {} by {}", diagnostics_)
          .helps(left_plain ? "divide by a plain number"
                            : "divide by a plain number, or by " +
                                  std::string(dimension_phrase(left.dimension())));
      return make_nothing(span);
    }
    unit = &plain;
  } else if (!left_plain && !right_plain) {
    report_mismatch(left, right, "this multiplies {} by {}", diagnostics_)
        .helps("one side of `*` must be a plain number");
    return make_nothing(span);
  }
  return combine(node.op, std::move(left), std::move(right), unit, span);
}

Typed Expressions::combine(ast::ArithmeticOp op, Typed left, Typed right, const Unit* unit,
                           Span span) {
  Typed result;
  result.type = Type::number;
  result.span = span;
  result.unit = unit;
  const Typed& named = left.source.empty() ? right : left;
  const bool same_unit = !named.source.empty() && named.unit == unit;
  result.source = same_unit ? named.source : "";
  result.unit_span = same_unit ? named.unit_span : span;
  result.code.operation = operation_of(op);
  set_range(result, left, right);
  if (left.is_constant() && right.is_constant()) return fold(left, right, std::move(result));
  result.code = make_binary(operation_of(op), std::move(left.code), std::move(right.code));
  return result;
}

Typed Expressions::fold(const Typed& left, const Typed& right, Typed result) {
  const vm::Value value = compute(result.code.operation, left.code.constant, right.code.constant);
  if (value == vm::kValueMax || value == vm::kValueMin) {
    const Unit& unit =
        result.unit == nullptr ? canonical_unit(vm::Dimension::number) : *result.unit;
    diagnostics_
        .report(Code::E0304, value > 0 ? "the result of this is above " + largest(unit) +
                                             ", the largest number that the robot can store"
                                       : "the result of this is below " + smallest(unit) +
                                             ", the smallest number that the robot can store")
        .label(result.span);
    return make_nothing(result.span);
  }
  result.code = {};
  result.code.constant = value;
  result.bare = {value, kBareDecimals};
  result.low = value;
  result.high = value;
  return result;
}

// A bare pair counts as plain numbers: the result is drawn on the robot, so unlike a literal it cannot take a unit later.
Typed Expressions::of(const ast::Random& node, Span span) {
  Typed low = number(*node.low);
  Typed high = number(*node.high);
  if (!low.is_number() || !high.is_number()) return make_nothing(span);
  if (!unify(low, high, "this draws a number between {} and {}", false, diagnostics_))
    return make_nothing(span);
  if (low.low > high.high) {
    diagnostics_.report(Code::E0509, "RANDOM takes the smaller number first").label(span);
    return make_nothing(span);
  }
  Typed result;
  result.type = Type::number;
  result.span = span;
  result.unit = low.unit != nullptr ? low.unit : &canonical_unit(vm::Dimension::number);
  result.unit_span = low.unit_span;
  result.low = low.low;
  result.high = high.high;
  result.code = make_binary(Operation::random, std::move(low.code), std::move(high.code));
  return result;
}

// ---- numbers that a word of the language takes: their dimension, and those that must be constant

namespace {

void report_amount(const Typed& number, const Wanted& wanted, Diagnostics& diagnostics) {
  Diagnostic& d =
      diagnostics
          .report(Code::E0301, "`" + wanted.source + "` is " +
                                   std::string(dimension_phrase(wanted.unit->dimension)) +
                                   ", but this is " +
                                   std::string(dimension_phrase(number.dimension())))
          .label(number.digits.empty() ? number.span : number.unit_span);
  help_with_unit(d, number, *wanted.unit);
  if (wanted.remembered && number.unit != nullptr &&
      wanted.unit->dimension == vm::Dimension::number)
    d.helps("to keep the unit, start it with one: `REMEMBER " + wanted.source + " = 0" +
            std::string(number.unit->spelling) + "`");
  if (number.digits.empty()) return;
  const bool minutes = wanted.unit->dimension == vm::Dimension::duration &&
                       number.unit != nullptr && number.unit->spelling == "m";
  const std::string mended = number.digits + (minutes ? "min" : std::string(wanted.unit->spelling));
  d.helps("did you mean `" + mended + "`?").fix(number.span, mended, Applicability::likely);
}

// Checks the dimension and reports a wrong one; a bare number takes the unit.
bool is_amount(Typed& number, const Wanted& wanted, Diagnostics& diagnostics) {
  if (number.is_bare()) take_unit(number, wanted, diagnostics);
  if (!number.is_number()) return false;
  if (number.dimension() == wanted.unit->dimension) return fits_scale(number, wanted, diagnostics);
  report_amount(number, wanted, diagnostics);
  return false;
}

}  // namespace

// Has a single result, so that returning it needs no move: every number of a program passes through here.
Typed Expressions::amount(const ast::Expr& expr, const Wanted& wanted) {
  Typed result = number(expr);
  if (!is_amount(result, wanted, diagnostics_)) result = make_nothing(expr.span);
  return result;
}

std::optional<Typed> Expressions::constant(const ast::Expr& expr, std::string_view what) {
  Typed result = number(expr);
  if (!result.is_number()) return std::nullopt;
  if (result.is_constant()) return result;
  diagnostics_.report(Code::E0305, std::string(what) + " must be known before the program runs")
      .label(expr.span)
      .helps("write a number or the name of a LET");
  return std::nullopt;
}

std::optional<Typed> Expressions::constant_amount(const ast::Expr& expr, const Wanted& wanted) {
  Typed result = amount(expr, wanted);
  if (!result.is_number()) return std::nullopt;
  if (result.is_constant()) return result;
  diagnostics_.report(Code::E0305, "this must be known before the program runs")
      .label(expr.span)
      .helps("write a number or the name of a LET");
  return std::nullopt;
}

namespace {

// "10s TO 20s" for `10s - 20s`; empty if it is something else.
std::string as_range(const ast::Expr& expr) {
  const auto* const difference = std::get_if<ast::Arithmetic>(&expr.node);
  if (difference == nullptr || difference->op != ast::ArithmeticOp::sub) return {};
  const auto* const low = std::get_if<ast::Quantity>(&difference->left->node);
  const auto* const high = std::get_if<ast::Quantity>(&difference->right->node);
  if (low == nullptr || high == nullptr) return {};
  std::string text(low->digits);
  text += low->unit.empty() ? high->unit : low->unit;
  return text.append(" TO ").append(high->digits).append(high->unit);
}

}  // namespace

Typed Expressions::duration(const ast::Expr& expr, std::string_view what) {
  Typed result =
      amount(expr, {&canonical_unit(vm::Dimension::duration), std::string(what), expr.span});
  if (!result.is_number() || result.high > 0) return result;
  Diagnostic& d =
      diagnostics_.report(Code::E0509, std::string(what) + " must be above 0").label(expr.span);
  if (const std::string range = as_range(expr); what == "EVERY" && !range.empty()) {
    d.message += ", and `-` subtracts";
    d.helps("for a random time in between, write `EVERY " + range + "`")
        .fix(expr.span, range, Applicability::likely);
  }
  return make_nothing(expr.span);
}

std::optional<vm::Value> Expressions::constant_duration(const ast::Expr& expr,
                                                        std::string_view what) {
  const Typed result = duration(expr, what);
  if (!result.is_number()) return std::nullopt;
  if (result.is_constant()) return result.code.constant;
  diagnostics_
      .report(Code::E0305, "`" + std::string(what) + "` must be known before the program runs")
      .label(expr.span)
      .helps("write a number or the name of a LET");
  return std::nullopt;
}

}  // namespace robosync::compiler
