// Part of Expressions: conditions on words and truths, and conditions that remember the past.
#include <algorithm>
#include <array>

#include "compiler/diagnostics/nearest.hpp"
#include "compiler/sema/condition_lints.hpp"
#include "compiler/sema/expressions.hpp"
#include "vm/arithmetic.hpp"

namespace robosync::compiler {

// ---- IS, IS TRUE, BECOMES

vm::Value label_value(std::size_t place) {
  return static_cast<vm::Value>(place) * vm::kScale;
}

namespace {

std::vector<std::string_view> split_words(std::string_view text) {
  std::vector<std::string_view> words;
  while (!text.empty()) {
    const std::size_t length = std::min(text.find(' '), text.size());
    words.push_back(text.substr(0, length));
    text.remove_prefix(std::min(length + 1, text.size()));
  }
  return words;
}

// `STATE mood: happy sad`: without commas the words are one, and such a STATE has nothing to change to. The same message for each
// place that uses one of them: they become one.
bool lacks_comma(Names& names, const ast::Name& label, std::string_view owner,
                 Diagnostics& diagnostics) {
  const VariableName* const variable = names.find_variable(owner);
  const auto* const state =
      variable == nullptr ? nullptr : std::get_if<const ast::State*>(&variable->declared);
  if (state == nullptr || (*state)->labels.size() != 1) return false;
  const ast::Name& whole = (*state)->labels.front();
  const std::vector<std::string_view> words = split_words(whole.text);
  const auto is_it = [&](std::string_view word) { return same_name(word, label.text); };
  if (words.size() < 2 || std::ranges::none_of(words, is_it)) return false;
  std::string better;
  for (const std::string_view word : words)
    better += (better.empty() ? "" : ", ") + std::string(word);
  Span place = whole.span;
  if (words.size() == 2) {
    place.begin += static_cast<std::uint32_t>(words.front().size());
    place.end -= static_cast<std::uint32_t>(words.back().size());
  }
  diagnostics
      .report(Code::E0008,
              words.size() == 2
                  ? "a comma is missing between `" + std::string(words.front()) + "` and `" +
                        std::string(words.back()) + "`"
                  : "commas are missing between the words of " + (*state)->name.shown())
      .label(place)
      .label(label.span, "used here", false)
      .helps("write `STATE " + std::string((*state)->name.text) + ": " + better + "`")
      .fix(whole.span, better, Applicability::likely);
  return true;
}

}  // namespace

std::optional<std::size_t> find_label(Names& names, const std::vector<std::string>& labels,
                                      const ast::Name& label, std::string_view owner,
                                      Diagnostics& diagnostics, bool quoted) {
  if (const auto place = names.find_label(labels, label.text)) return place;
  if (label.text.empty()) return std::nullopt;  // missing; reported already
  if (lacks_comma(names, label, owner, diagnostics)) return std::nullopt;
  Diagnostic& d =
      diagnostics.report(Code::E0501, "`" + std::string(owner) + "` is never " + label.shown())
          .label(label.span);
  if (!diagnostics.may_search(labels.size())) return std::nullopt;
  if (!did_you_mean(d, label.span, label.text, labels, quoted ? "\"" : ""))
    d.helps("it is " + list_names(labels, "or"));
  return std::nullopt;
}

Diagnostic& report_word(const Typed& word, std::string_view wanted, Diagnostics& diagnostics) {
  return diagnostics
      .report(Code::E0306, "`" + word.source + "` is a word, not " + std::string(wanted))
      .label(word.span)
      .helps("test it with IS: it is " + list_names(*word.labels, "or"));
}

namespace {

// The words that the grammar reads as a value: `very happy`.
std::string words_of(const ast::Expr& expr) {
  const auto* const operand = std::get_if<ast::Operand>(&expr.node);
  if (operand == nullptr) return {};
  std::string words(operand->name.text);
  if (operand->channel) words.append(" ").append(operand->channel->text);
  return words;
}

// The truth that `= 1` and `= 0` test for; empty for any other number.
std::string truth_of(const ast::Expr& expr) {
  const auto* const number = std::get_if<ast::Quantity>(&expr.node);
  if (number == nullptr || !number->unit.empty()) return {};
  if (number->digits == "1") return "TRUE";
  return number->digits == "0" ? "FALSE" : "";
}

}  // namespace

// `mood IS calm OR happy`, `touch LEVEL = 3 OR 4`: the first question is meant to continue. Reports it.
bool Expressions::asks_nothing(const ast::Logic& node) {
  const ast::Expr* last = node.left.get();
  while (const auto* const logic = std::get_if<ast::Logic>(&last->node))
    last = logic->right.get();
  const auto* const is = std::get_if<ast::Is>(&last->node);
  const auto* const equal = std::get_if<ast::Comparison>(&last->node);
  const auto* const number = std::get_if<ast::Quantity>(&node.right->node);
  const std::string word = words_of(*node.right);
  std::string question;
  if (is != nullptr && !word.empty()) {
    const Typed asked = any(*is->value);
    if (asked.labels == nullptr || !names_.find_label(*asked.labels, word)) return false;
    question = words_of(*is->value) + (is->negated ? " IS NOT " : " IS ") + word;
  } else if (equal != nullptr && number != nullptr && equal->relation == ast::Relation::equal) {
    question = words_of(*equal->left) + " = " + std::string(number->digits).append(number->unit);
  } else {
    return false;
  }
  Diagnostic& d = diagnostics_.report(Code::E0302, "this is not a condition on its own")
                      .label(node.right->span)
                      .helps("repeat what is tested: `" + question + "`");
  if (question.front() != ' ' && node.op == ast::LogicOp::or_ && (is == nullptr || !is->negated))
    d.fix(node.right->span, question, Applicability::likely);
  return true;
}

// `mood = calm`
void Expressions::report_word_comparison(const ast::Comparison& node, const Typed& word) {
  const bool same = node.relation == ast::Relation::equal;
  const std::string words = node.right ? words_of(*node.right) : std::string();
  const bool known = names_.find_label(*word.labels, words).has_value();
  const std::string truth = word.truth && node.right ? truth_of(*node.right) : std::string();
  Diagnostic& d = report_word(word, "a number", diagnostics_);
  if (!same && node.relation != ast::Relation::not_equal) return;
  const std::string is = same ? "IS" : "IS NOT";
  if (known) {
    d.help.back() = "test it with IS: `" + word.source + " " + is + " " + words + "`";
    d.fix(node.relation_span, is);
  } else if (!truth.empty() && same) {
    const Span behind{node.relation_span.file, node.relation_span.begin, node.right->span.end};
    d.help.back() = "it is true or false: `" + word.source + " IS " + truth + "`";
    d.fix(behind, "IS " + truth, Applicability::likely);
  }
}

bool Expressions::learns_words(const Typed& word) const {
  return word.code.operation == Operation::input && names_.channel(word.code.channel).learns_words;
}

// A channel that learns its words accepts a new one, except UNKNOWN, which does not mean a word.
std::optional<std::size_t> Expressions::place_of(const ast::Name& label, const Typed& word,
                                                 bool quoted) {
  if (learns_words(word) && !label.text.empty() && !same_name(label.text, "unknown") &&
      !names_.find_label(*word.labels, label.text)) {
    const std::size_t place = names_.learn_label(word.code.channel, label.text);
    if (place < kMaxLabels) return place;
    diagnostics_
        .report(Code::E0205, "`" + word.source + "` is compared with more than " +
                                 std::to_string(kMaxLabels - 1) + " words")
        .label(label.span);
    return std::nullopt;
  }
  return find_label(names_, *word.labels, label, word.source, diagnostics_, quoted);
}

Typed Expressions::label_test(Operation operation, const ast::Expr& value, const ast::Name& label,
                              Span span, bool quoted) {
  Typed word = any(value);
  if (word.type == Type::nothing) return word;
  if (word.type != Type::word) {
    Diagnostic& d =
        diagnostics_
            .report(Code::E0306, word.is_number()
                                     ? "this is a number, but " + label.shown() + " is a word"
                                     : "this is a condition, but " + label.shown() + " is a word")
            .label(value.span)
            .label(label.span, "the word", false);
    if (word.code.operation == Operation::input)
      d.helps("if the sensor gives words, list them under \"labels\" in robot.json");
    else if (word.is_number())
      d.helps("compare a number with `=`, `<` or `>`");
    return make_nothing(span);
  }
  const auto place = place_of(label, word, quoted);
  if (!place) return make_nothing(span);
  return make_condition(
      make_binary(operation, std::move(word.code), make_constant_code(label_value(*place))), span);
}

Typed Expressions::of(const ast::Is& node, Span span) {
  return label_test(node.negated ? Operation::not_equal : Operation::equal, *node.value, node.label,
                    span, node.is_string);
}

Typed Expressions::of(const ast::Becomes& node, Span span) {
  Typed test = label_test(Operation::equal, *node.value, node.label, span);
  if (test.type != Type::condition) return test;
  return make_condition(make_unary(Operation::rose, std::move(test.code)), span);
}

Typed Expressions::of(const ast::IsTruth& node, Span span) {
  Typed truth = condition(*node.value);
  if (truth.type != Type::condition) return make_nothing(span);
  if (node.truth) return make_condition(std::move(truth.code), span);
  return make_condition(make_unary(Operation::logical_not, std::move(truth.code)), span);
}

// ---- time words, and comparisons with a MARGIN

namespace {

Operation operation_of(ast::Relation relation) {
  constexpr std::array kOperations = {Operation::less,       Operation::greater,
                                      Operation::less_equal, Operation::greater_equal,
                                      Operation::equal,      Operation::not_equal};
  return kOperations[static_cast<std::size_t>(relation)];
}

// `side` plus a constant, folded if possible.
Expression moved(const Expression& side, vm::Value by) {
  if (side.operation == Operation::constant) return make_constant_code(vm::add(side.constant, by));
  return make_binary(Operation::add, side, make_constant_code(by));
}

// The comparison that becomes false `margin` later than `enter` does.
Expression stay_condition(const Expression& enter, vm::Value margin) {
  const bool below = enter.operation == Operation::less || enter.operation == Operation::less_equal;
  const auto operation = below ? Operation::less_equal : Operation::greater_equal;
  const vm::Value by = below ? margin : -margin;
  const Expression& left = enter.operands[0];
  const Expression& right = enter.operands[1];
  if (left.operation == Operation::constant) return make_binary(operation, moved(left, -by), right);
  return make_binary(operation, left, moved(right, by));
}

bool is_order(ast::Relation relation) {
  return relation != ast::Relation::equal && relation != ast::Relation::not_equal;
}

Expression time_word(Operation operation, Expression operand, vm::Value duration) {
  Expression result = make_unary(operation, std::move(operand));
  result.constant = duration;
  return result;
}

}  // namespace

Typed Expressions::condition(const ast::Expr& expr, const ast::Expr* margin) {
  if (margin == nullptr) return condition(expr);
  const auto value = constant(*margin, "MARGIN");
  if (!value) return condition(expr);
  Margin open{*value, false};
  make_difference(open.value);
  if (open.value.code.constant <= 0) {
    diagnostics_.report(Code::E0509, "MARGIN must be above 0").label(margin->span);
    return condition(expr);
  }
  margin_ = &open;
  Typed result = condition(expr);
  margin_ = nullptr;
  if (result.type == Type::condition && !open.used)
    diagnostics_.report(Code::E0409, "this condition has no comparison that a MARGIN applies to")
        .label(margin->span)
        .helps(reads_time(result.code) ? "a TIMER does not flicker, so it needs no MARGIN"
                                       : "a MARGIN applies to `<`, `>`, `<=`, `>=` and IS BETWEEN, "
                                         "in the same kind of unit");
  return result;
}

// Does the open MARGIN apply to a comparison of these?
bool Expressions::takes_margin(const Typed& left, const Typed& right) {
  if (margin_ == nullptr || (left.is_constant() && right.is_constant())) return false;
  const Typed& side = left.is_constant() ? right : left;
  if (side.unit == nullptr) return false;
  Typed& margin = margin_->value;
  if (margin.is_bare()) take_unit(margin, {side.unit, side.source, {}, true}, diagnostics_);
  if (!margin.is_number() || margin.dimension() != side.unit->dimension) return false;
  margin_->used = true;
  return true;
}

Expression Expressions::compare(ast::Relation relation, Typed left, Typed right) {
  const bool sticks = is_order(relation) && takes_margin(left, right);
  if (sticks && !is_given()) lint_margin(relation, left, right, margin_->value, diagnostics_);
  Expression enter =
      make_binary(operation_of(relation), std::move(left.code), std::move(right.code));
  if (!sticks) return enter;
  Expression stay = stay_condition(enter, margin_->value.code.constant);
  return make_binary(Operation::latch, std::move(enter), std::move(stay));
}

// One condition: with a MARGIN it becomes true between the numbers, and stays true up to the MARGIN beyond either.
Expression Expressions::between(Typed value, Typed same, Typed low, Typed high) {
  const bool sticks = takes_margin(value, low) || takes_margin(same, high);
  if (sticks && !is_given()) lint_margin(value, low, high, margin_->value, diagnostics_);
  Expression above =
      make_binary(Operation::greater_equal, std::move(value.code), std::move(low.code));
  Expression below = make_binary(Operation::less_equal, std::move(same.code), std::move(high.code));
  if (!sticks) return make_binary(Operation::logical_and, std::move(above), std::move(below));
  const vm::Value by = margin_->value.code.constant;
  Expression stay =
      make_binary(Operation::logical_and, stay_condition(above, by), stay_condition(below, by));
  return make_binary(Operation::latch,
                     make_binary(Operation::logical_and, std::move(above), std::move(below)),
                     std::move(stay));
}

Typed Expressions::of(const ast::IsBetween& node, Span span) {
  Typed value = any(*node.value);
  if (value.type == Type::word) {
    report_word(value, "a number", diagnostics_);
    return make_nothing(span);
  }
  value = number_of(std::move(value));
  Typed low = number(*node.low);
  Typed high = number(*node.high);
  if (!value.is_number() || !low.is_number() || !high.is_number()) return make_nothing(span);
  Typed same = value;  // the value is in two comparisons
  if (!unify(value, low, "this compares {} with {}", false, diagnostics_) ||
      !unify(same, high, "this compares {} with {}", false, diagnostics_))
    return make_nothing(span);
  if (low.low > high.high) {
    diagnostics_.report(Code::E0509, "BETWEEN takes the smaller number first").label(span);
    return make_nothing(span);
  }
  if (!is_given()) lint_between(value, low, high, span, diagnostics_);
  if (reads_time(value.code) || reads_time(low.code) || reads_time(high.code))
    return time_between(std::move(value), std::move(low), std::move(high), span);
  return make_condition(between(std::move(value), std::move(same), std::move(low), std::move(high)),
                        span);
}

Typed Expressions::of(const ast::Changes& node, Span span) {
  Typed value = any(*node.value);
  if (value.type == Type::condition) value = number(*node.value);  // reports the mistake
  if (value.type == Type::nothing) return value;
  if (!stands_still(value.code, value.span, "CHANGES")) return make_nothing(span);
  vm::Value least = 0;
  if (node.by != nullptr) {
    if (value.type == Type::word) {
      diagnostics_
          .report(Code::E0306,
                  "`" + value.source + "` is a word, and a word `CHANGES` without `BY`")
          .label(node.by->span);
      return make_nothing(span);
    }
    const Unit& unit = value.unit != nullptr ? *value.unit : canonical_unit(vm::Dimension::number);
    const auto by = constant_amount(*node.by, {&unit, "CHANGES BY", value.unit_span, true});
    if (!by) return make_nothing(span);
    least = by->code.constant;
    if (least <= 0) {
      diagnostics_.report(Code::E0509, "CHANGES BY must be above 0").label(node.by->span);
      return make_nothing(span);
    }
    if (!is_given()) lint_step(value, *by, diagnostics_);
  }
  return make_condition(time_word(Operation::changed, std::move(value.code), least), span);
}

Typed Expressions::of(const ast::For& node, Span span) {
  Typed inner = condition(*node.condition);
  const auto duration = constant_duration(*node.duration, "FOR");
  if (inner.type != Type::condition || !duration) return make_nothing(span);
  lint_held(*node.condition, inner.code, diagnostics_);
  return make_condition(time_word(Operation::held, std::move(inner.code), *duration), span);
}

Typed Expressions::of(const ast::ThenWithin& node, Span span) {
  Typed first = condition(*node.first);
  Typed second = condition(*node.second);
  const auto within = constant_duration(*node.within, "WITHIN");
  if (first.type != Type::condition || second.type != Type::condition || !within)
    return make_nothing(span);
  Expression code = time_word(Operation::sequence, std::move(first.code), *within);
  code.operands.push_back(std::move(second.code));
  return make_condition(std::move(code), span);
}

Typed Expressions::of(const ast::TimesWithin& node, Span span) {
  Typed inner = condition(*node.condition);
  const auto within = constant_duration(*node.within, "WITHIN");
  if (node.times < 1 || node.times > vm::kMaxEdges) {
    diagnostics_
        .report(Code::E0509,
                "a condition can be counted from 1 to " + std::to_string(vm::kMaxEdges) + " TIMES")
        .label(span);
    return make_nothing(span);
  }
  if (inner.type != Type::condition || !within) return make_nothing(span);
  Expression code = time_word(Operation::counted, std::move(inner.code), *within);
  code.index = node.times;
  return make_condition(std::move(code), span);
}

}  // namespace robosync::compiler
