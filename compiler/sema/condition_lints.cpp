// See condition_lints.hpp. These warnings are certain: while a sensor is unknown, no condition is true or false
// anyway.
#include "compiler/sema/condition_lints.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "compiler/sema/intervals.hpp"
#include "compiler/units/units.hpp"

namespace robosync::compiler {

bool draws(const Expression& expression) {
  return expression.operation == Operation::random ||
         std::ranges::any_of(expression.operands, draws);
}

// ---- W0210: one comparison, by the ranges of its sides

namespace {

// The result of left < right, if the ranges of the sides decide it.
std::optional<bool> decided_less(const Typed& left, const Typed& right) {
  if (left.high < right.low) return true;
  if (left.low >= right.high) return false;
  return std::nullopt;
}

std::optional<bool> opposite(std::optional<bool> decided) {
  if (decided) return !*decided;
  return std::nullopt;
}

std::optional<bool> decided_equal(const Typed& left, const Typed& right) {
  if (left.high < right.low || right.high < left.low) return false;
  if (left.low == left.high && right.low == right.high) return true;
  return std::nullopt;
}

std::optional<bool> decided(ast::Relation relation, const Typed& left, const Typed& right) {
  switch (relation) {
    case ast::Relation::less:
      return decided_less(left, right);
    case ast::Relation::greater:
      return decided_less(right, left);
    case ast::Relation::less_equal:
      return opposite(decided_less(right, left));
    case ast::Relation::greater_equal:
      return opposite(decided_less(left, right));
    case ast::Relation::equal:
      return decided_equal(left, right);
    case ast::Relation::not_equal:
      return opposite(decided_equal(left, right));
  }
  return std::nullopt;
}

void label_range(Diagnostic& diagnostic, const Typed& side) {
  if (side.source.empty() || side.is_constant()) return;
  diagnostic.label(side.span,
                   "goes from " + format_value(side.low, *side.unit) + " to " +
                       format_value(side.high, *side.unit),
                   false);
}

Diagnostic& report_decided(bool always, Span span, Diagnostics& diagnostics) {
  return diagnostics.report(Code::W0210, always ? "this is always true" : "this is never true")
      .label(span);
}

bool is_below(ast::Relation relation) {
  return relation == ast::Relation::less || relation == ast::Relation::less_equal;
}

}  // namespace

void lint_comparison(ast::Relation relation, const Typed& left, const Typed& right, Span span,
                     Diagnostics& diagnostics) {
  const auto result = decided(relation, left, right);
  if (!result) return;
  Diagnostic& d = report_decided(*result, span, diagnostics);
  label_range(d, left);
  label_range(d, right);
}

void lint_between(const Typed& value, const Typed& low, const Typed& high, Span span,
                  Diagnostics& diagnostics) {
  const auto above = decided(ast::Relation::greater_equal, value, low);
  const auto below = decided(ast::Relation::less_equal, value, high);
  const bool never = !above.value_or(true) || !below.value_or(true);
  if (!never && !(above && below)) return;
  label_range(report_decided(!never, span, diagnostics), value);
}

namespace {

bool stays_true(ast::Relation relation, const Typed& left, const Typed& right, std::int64_t by) {
  return is_below(relation) ? left.high <= right.low + by : left.low >= right.high - by;
}

Diagnostic& report_stays(const Typed& margin, Diagnostics& diagnostics) {
  return diagnostics
      .report(Code::W0210, "once this is true, it stays true: no value gets past it by the MARGIN")
      .label(margin.span);
}

}  // namespace

void lint_margin(ast::Relation relation, const Typed& left, const Typed& right, const Typed& margin,
                 Diagnostics& diagnostics) {
  if (decided(relation, left, right)) return;
  if (!stays_true(relation, left, right, margin.code.constant)) return;
  Diagnostic& d = report_stays(margin, diagnostics);
  label_range(d, left);
  label_range(d, right);
}

void lint_margin(const Typed& value, const Typed& low, const Typed& high, const Typed& margin,
                 Diagnostics& diagnostics) {
  const auto above = decided(ast::Relation::greater_equal, value, low);
  const auto below = decided(ast::Relation::less_equal, value, high);
  if (above == false || below == false || (above && below)) return;
  const std::int64_t by = margin.code.constant;
  if (stays_true(ast::Relation::greater_equal, value, low, by) &&
      stays_true(ast::Relation::less_equal, value, high, by))
    label_range(report_stays(margin, diagnostics), value);
}

void lint_step(const Typed& value, const Typed& by, Diagnostics& diagnostics) {
  if (value.high - value.low >= by.code.constant) return;
  label_range(diagnostics.report(Code::W0210, "this is never true: it cannot change by that much")
                  .label(by.span),
              value);
}

// ---- W0210: AND and OR of comparisons of one thing with constants

namespace {

Intervals both(const Intervals& a, const Intervals& b) {
  Intervals result;
  for (const Interval& one : a)
    for (const Interval& other : b)
      if (std::max(one.low, other.low) <= std::min(one.high, other.high))
        result.push_back({std::max(one.low, other.low), std::min(one.high, other.high)});
  return result;
}

Intervals together(Intervals a, const Intervals& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

// A condition on one value: the ranges in which it may be true, and those in which it must be true.
struct Asked {
  const Expression* side = nullptr;
  Intervals may, must;
};

// Are they about the same value, with few enough ranges?
constexpr std::size_t kMostRanges = 64;
bool same_side(const std::optional<Asked>& a, const std::optional<Asked>& b) {
  return a && b && a->may.size() + b->may.size() <= kMostRanges &&
         a->must.size() + b->must.size() <= kMostRanges && *a->side == *b->side;
}

std::optional<Intervals> ranges_of(Operation comparison, std::int64_t number) {
  switch (comparison) {
    case Operation::less:
      return Intervals{{vm::kValueMin, number - 1}};
    case Operation::less_equal:
      return Intervals{{vm::kValueMin, number}};
    case Operation::greater:
      return Intervals{{number + 1, vm::kValueMax}};
    case Operation::greater_equal:
      return Intervals{{number, vm::kValueMax}};
    case Operation::equal:
      return Intervals{{number, number}};
    case Operation::not_equal:
      return without({{}}, Interval{number, number});
    default:
      return std::nullopt;
  }
}

std::optional<Asked> comparison_of(const Expression& condition) {
  if (!is_comparison(condition.operation)) return std::nullopt;
  const Expression& left = condition.operands[0];
  const Expression& right = condition.operands[1];
  const bool turned = left.operation == Operation::constant;
  if (turned == (right.operation == Operation::constant)) return std::nullopt;
  const Expression& side = turned ? right : left;
  const auto ranges = ranges_of(turned ? mirrored(condition.operation) : condition.operation,
                                (turned ? left : right).constant);
  if (!ranges || draws(side)) return std::nullopt;
  return Asked{&side, *ranges, *ranges};
}

std::optional<Asked> asked(const Expression& condition);

// With a MARGIN (a latch) the condition must be true in the enter range and may be true in the stay range.
std::optional<Asked> asked_by_two(const Expression& condition) {
  auto first = asked(condition.operands[0]);
  const auto second = asked(condition.operands[1]);
  if (!same_side(first, second)) return std::nullopt;
  if (condition.operation == Operation::logical_and)
    return Asked{first->side, both(first->may, second->may), both(first->must, second->must)};
  const bool sticks = condition.operation == Operation::latch;
  return Asked{first->side, together(first->may, second->may),
               sticks ? first->must : together(first->must, second->must)};
}

std::optional<Asked> asked(const Expression& condition) {
  switch (condition.operation) {
    case Operation::logical_and:
    case Operation::logical_or:
    case Operation::latch:
      return asked_by_two(condition);
    case Operation::logical_not: {
      const auto inner = asked(condition.operands[0]);
      if (!inner) return std::nullopt;
      return Asked{inner->side, without({{}}, inner->must), without({{}}, inner->may)};
    }
    case Operation::held:
    case Operation::rose: {
      auto inner = asked(condition.operands[0]);
      if (inner) inner->must.clear();
      return inner;
    }
    default:
      return comparison_of(condition);
  }
}

void collect(Operation op, const Expression& condition, std::vector<Asked>& result) {
  if (condition.operation == op) {
    for (const Expression& operand : condition.operands)
      collect(op, operand, result);
  } else if (auto one = asked(condition)) {
    result.push_back(std::move(*one));
  }
}

// All possible values. A channel that learns its words may get new ones later.
Intervals possible(const Expression& side, Names& names) {
  const auto of = [](const std::vector<std::string>& labels, std::int64_t low, std::int64_t high) {
    if (labels.empty()) return Intervals{{low, high}};
    Intervals words;
    for (std::size_t i = 0; i < labels.size(); ++i) {
      const auto word = static_cast<std::int64_t>(i) * vm::kScale;
      words.push_back({word, word});
    }
    return words;
  };
  if (side.operation == Operation::variable) {
    const VariableName& variable = names.variables()[side.index];
    return of(variable.labels, variable.low, variable.high);
  }
  if (side.operation != Operation::input) return {{}};
  const ChannelConfig& channel = names.channel(side.channel);
  if (channel.learns_words) return {{}};
  return of(channel.labels, channel.min, channel.max);
}

std::string name_of(const Expression& side, Names& names) {
  if (side.operation == Operation::input) return "`" + names.channel_name(side.channel) + "`";
  if (side.operation == Operation::variable) return names.variables()[side.index].name.shown();
  return "it";
}

// The rest of `ranges` if all `parts` about this side are true (or false).
Intervals left_by(const std::vector<Asked>& parts, const Expression& side, bool are_true,
                  Intervals ranges) {
  for (const Asked& part : parts) {
    if (*part.side != side || ranges.size() > kMostRanges) continue;
    ranges = are_true ? both(ranges, part.may) : without(std::move(ranges), part.must);
  }
  return ranges;
}

}  // namespace

void lint_logic(ast::LogicOp op, const Expression& left, const Expression& right, Span span,
                Names& names, Diagnostics& diagnostics) {
  const bool all = op == ast::LogicOp::and_;
  const Operation operation = all ? Operation::logical_and : Operation::logical_or;
  std::vector<Asked> first, second;
  collect(operation, right, second);
  if (second.empty()) return;
  collect(operation, left, first);
  for (const Asked& part : second) {
    const Expression& side = *part.side;
    const Intervals range = possible(side, names);
    const Intervals by_first = left_by(first, side, all, range);
    if (by_first.empty() || left_by(second, side, all, range).empty()) continue;  // reported before
    if (!left_by(second, side, all, by_first).empty()) continue;
    const std::string name = name_of(side, names);
    Diagnostic& d =
        diagnostics
            .report(Code::W0210,
                    all ? "this is never true: " + name + " can never meet all these conditions"
                        : "this is always true: " + name + " always meets one of these conditions")
            .label(span);
    if (all)
      d.helps("to test whether it is one of them, write OR");
    else if (!left_by(second, side, true, left_by(first, side, true, range)).empty())
      d.helps("to test whether it is all of them, write AND");
    return;
  }
}

// ---- W0220: moments

namespace {

bool is_moment(const Expression& condition) {
  switch (condition.operation) {
    case Operation::rose:
    case Operation::changed:
    case Operation::counted:
    case Operation::sequence:
      return true;
    case Operation::logical_and:
      return std::ranges::any_of(condition.operands, is_moment);
    case Operation::logical_or:
      return std::ranges::all_of(condition.operands, is_moment);
    default:
      return false;
  }
}

// The words that the grammar reads as a value; empty for any other expression.
std::string words_of(const ast::Box<ast::Expr>& value) {
  const auto* const operand = value ? std::get_if<ast::Operand>(&value->node) : nullptr;
  if (operand == nullptr) return {};
  std::string words(operand->name.text);
  if (operand->channel) words.append(" ").append(operand->channel->text);
  return words;
}

// `mood BECOMES happy` was meant as `mood IS happy`.
bool offer_is(const ast::Expr& condition, Diagnostic& diagnostic) {
  const auto* const becomes = std::get_if<ast::Becomes>(&condition.node);
  const std::string words = becomes != nullptr ? words_of(becomes->value) : "";
  if (words.empty()) return false;
  const Span between{condition.span.file, becomes->value->span.end, becomes->label.span.begin};
  diagnostic
      .helps("use IS for something that lasts: `" + words + " IS " +
             std::string(becomes->label.text) + "`")
      .fix(between, " IS ", Applicability::likely);
  return true;
}

}  // namespace

void lint_held(const ast::Expr& condition, const Expression& code, Diagnostics& diagnostics) {
  if (!is_moment(code)) return;
  Diagnostic& d =
      diagnostics
          .report(Code::W0220,
                  "this is true only for a moment, so it never lasts as long as FOR requires")
          .label(condition.span);
  if (offer_is(condition, d)) return;
  const auto* const changes = std::get_if<ast::Changes>(&condition.node);
  const std::string words = changes != nullptr ? words_of(changes->value) : "";
  if (!words.empty())
    d.helps("to test whether it has stayed the same, write NOT: `NOT (" + words +
            " CHANGES) FOR …`");
  d.helps("to act later, remove FOR and begin the response with a WAIT");
}

void lint_while(const ast::Rule& rule, const ast::Expr& condition, const Expression& code,
                Diagnostics& diagnostics) {
  if (!is_moment(code)) return;
  Diagnostic& d =
      diagnostics
          .report(Code::W0220,
                  "this is true only for a moment: WHILE would end its response immediately")
          .label(condition.span);
  const bool offered = offer_is(condition, d);
  d.helps("WHEN runs the whole response each time");
  constexpr std::uint32_t kLength = 5;  // of WHILE
  if (!offered)
    d.fix({rule.span.file, rule.span.begin, rule.span.begin + kLength}, "WHEN",
          Applicability::likely);
}

bool lint_sides(const ast::Expr& condition, const Expression& code, Diagnostics& diagnostics) {
  if (!is_moment(code)) return false;
  Diagnostic& d = diagnostics
                      .report(Code::W0220,
                              "this is true only for a moment: the ELSE side would interrupt the "
                              "DO side after 1 ms")
                      .label(condition.span);
  offer_is(condition, d);
  d.helps("without ELSE, WHEN runs the whole response each time");
  return true;
}

}  // namespace robosync::compiler
