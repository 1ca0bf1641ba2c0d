// What can be said of single conditions while they are translated.
#include <optional>

#include "compiler/sema/lints.hpp"

namespace robosync::compiler {
namespace {

// Whether left < right is decided by what the sides can be, and how.
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

std::string_view opposite_sign(ast::Relation relation) {
  switch (relation) {
    case ast::Relation::less:
      return ">=";
    case ast::Relation::less_equal:
      return ">";
    case ast::Relation::greater:
      return "<=";
    case ast::Relation::greater_equal:
      return "<";
    case ast::Relation::equal:
      return "<>";
    case ast::Relation::not_equal:
      return "=";
  }
  return "";
}

std::string text_of(const ast::Block& block, const SourceMap& sources) {
  if (block.empty()) return "";
  const Span span{block.front().span.file, block.front().span.begin, block.back().span.end};
  return std::string(sources.text(span));
}

// The heads of two rules that wait for a change.
struct TwoRules {
  std::string then_head, else_head;
};

// For `channel < number` with a channel that rests at 0.
std::optional<TwoRules> rules_without_start(const ast::WhenRule& when, const Names& names,
                                            const Typed& condition, const SourceMap& sources) {
  const auto* comparison = std::get_if<ast::Comparison>(&when.condition->node);
  if (comparison == nullptr || condition.code.operands.size() != 2) return std::nullopt;
  const Expression& left = condition.code.operands[0];
  const Expression& right = condition.code.operands[1];
  const bool below = comparison->relation == ast::Relation::less ||
                     comparison->relation == ast::Relation::less_equal;
  if (!below || left.operation != Operation::input || right.operation != Operation::constant ||
      names.channel(left.channel).min != 0 || right.constant <= 0)
    return std::nullopt;
  const std::string channel(sources.text(comparison->left->span));
  const std::string number(sources.text(comparison->right->span));
  const std::string whole(sources.text(when.condition->span));
  return TwoRules{
      "WHEN " + channel + " > 0 AND " + whole,
      "WHEN " + channel + " " + std::string(opposite_sign(comparison->relation)) + " " + number};
}

}  // namespace

void lint_comparison(ast::Relation relation, const Typed& left, const Typed& right, Span span,
                     Diagnostics& diagnostics) {
  const auto result = decided(relation, left, right);
  if (!result) return;
  Diagnostic& d =
      diagnostics.report(Code::W0210, *result ? "this is always true" : "this is never true")
          .label(span);
  label_range(d, left);
  label_range(d, right);
}

void lint_start(const ast::Rule& rule, const ast::WhenRule& when, const Names& names,
                const Typed& condition, const SourceMap& sources, Diagnostics& diagnostics) {
  Diagnostic& d =
      diagnostics.report(Code::W0203, "this rule acts at start: the first reading chooses a side")
          .label(rule.head_span);
  const auto rules = rules_without_start(when, names, condition, sources);
  if (!rules) {
    d.helps("to wait for a change, write a WHEN without ELSE for each side");
    return;
  }
  d.helps("to wait for a change, write two rules: `" + rules->then_head + "` and `" +
          rules->else_head + "`")
      .fix(rule.span, rules->then_head + "\nDO\n" + text_of(when.then_block, sources) +
                          "\nEND\n\n" + rules->else_head + "\nDO\n" +
                          text_of(*when.else_block, sources) + "\nEND");
}

}  // namespace robosync::compiler
