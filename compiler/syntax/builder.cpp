// See builder.hpp.
#include "compiler/syntax/builder.hpp"

#include <algorithm>
#include <charconv>
#include <iterator>

#include "compiler/diagnostics/nearest.hpp"
#include "compiler/source/ascii.hpp"

namespace robosync::compiler {

namespace {

// Deeper than anyone writes, and shallow enough for the stack of any walk over the tree.
constexpr std::uint16_t deepest_expression = 100;

bool all_digits(std::string_view text) {
  return std::all_of(text.begin(), text.end(), ascii::is_digit);
}

Span between(Span first, Span last) {
  return {first.file, first.begin, last.end};
}

}  // namespace

Diagnostic& Builder::report(Code code, std::string message) {
  if (diagnostics_ != nullptr) return diagnostics_->report(code, std::move(message));
  unseen_ = {};
  return unseen_;
}

void Builder::restart(Diagnostics* diagnostics) {
  diagnostics_ = diagnostics;
  items_.clear();
  moved_out_.clear();
  expected_.clear();
  keyword_names_.clear();
  too_deep_ = false;
}

void Builder::finish(std::vector<ast::Item> items) {
  items_ = std::move(items);
  std::move(moved_out_.begin(), moved_out_.end(), std::back_inserter(items_));
}

// ---- leaves

ast::Name Builder::name(Span span) const {
  return {text_of(span), span};
}

ast::Name Builder::quoted(Span span) const {
  std::string_view text = text_of(span);
  const char quote = text.empty() ? '\0' : text.front();
  if (quote == '"' || quote == '\'') {
    text.remove_prefix(1);
    if (!text.empty() && text.back() == quote) text.remove_suffix(1);
  }
  return {text, span};
}

ast::Use Builder::use(Span word, ast::Use use) const {
  const std::string_view text = text_of(word);
  use.is_guess = text.empty();
  // USE replaced another word, such as SAY: the name after it is not a module.
  if (!use.is_guess && !is_near(text, "USE")) use.module.text = {};
  return use;
}

ast::Name Builder::longer_label(const ast::Name& label, Span next) {
  const Span whole = between(label.span, next);
  std::string text = std::string(label.text) + " " + std::string(text_of(next));
  if (text_of(whole) == text) return {text_of(whole), whole};
  labels_.push_front(std::move(text));
  return {labels_.front(), whole};
}

ast::Name Builder::whole_number(Span span) {
  const std::string_view text = text_of(span);
  // Text that does not begin with a digit was already repaired and reported by repair.cpp.
  if (!text.empty() && ascii::is_digit(text.front()) && !all_digits(text)) {
    report(Code::E0004, "this must be a whole number without a unit").label(span);
  }
  return name(span);
}

ast::Box<ast::Expr> Builder::quantity(Span span) {
  const std::string_view text = text_of(span);
  const auto unit = std::find_if(text.begin(), text.end(),
                                 [](char c) { return !ascii::is_digit(c) && c != '.'; });
  const auto digits = static_cast<std::uint32_t>(unit - text.begin());
  const Span unit_span{span.file, span.begin + digits, span.end};
  return expr(span, ast::Quantity{text.substr(0, digits), text.substr(digits), unit_span});
}

ast::Box<ast::Expr> Builder::operand(Span span, Span first, std::optional<Span> channel) {
  ast::Operand operand{name(first), nullptr};
  if (channel) operand.channel = std::make_unique<ast::Name>(name(*channel));
  return expr(span, std::move(operand));
}

ast::Box<ast::Expr> Builder::truth(Span span, bool value) {
  return expr(span, ast::IsTruth{nullptr, value});
}

// ---- expressions

ast::Box<ast::Expr> Builder::shallow(ast::Box<ast::Expr> made) {
  if (made->depth <= deepest_expression) return made;
  if (!too_deep_) {
    report(Code::E0012, "this expression is nested deeper than " +
                            std::to_string(deepest_expression) + " levels, the most that rsc reads")
        .label(made->span)
        .helps(std::string(kSimplify));
  }
  too_deep_ = true;
  return expr(made->span, ast::Quantity{});
}

ast::Box<ast::Expr> Builder::is_between(Span span, ast::IsBetween node, bool negated) {
  auto made = expr(span, std::move(node));
  return negated ? expr(span, ast::Not{std::move(made)}) : std::move(made);
}

ast::Box<ast::Expr> Builder::times_within(Span span, ast::Box<ast::Expr> condition, Span times,
                                          ast::Box<ast::Expr> within) {
  const std::string_view digits = whole_number(times).text;
  std::uint32_t count = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), count);
  if (error == std::errc::result_out_of_range) {
    report(Code::E0004, "a condition cannot be counted that many times").label(times);
  }
  return expr(span, ast::TimesWithin{std::move(condition), count, std::move(within)});
}

// ---- arguments

ast::Argument Builder::word(Span span) const {
  return {span, ast::Preposition::none, ast::Word{name(span)}};
}

ast::Argument Builder::text(Span span) const {
  return {span, ast::Preposition::none, ast::Text{quoted(span).text}};
}

ast::Argument Builder::amount(Span span, ast::Box<ast::Expr> value, bool times) const {
  return {span, ast::Preposition::none, ast::Amount{std::move(value), times}};
}

ast::Command Builder::command(Span verb, std::vector<ast::Argument> arguments,
                              std::vector<ast::Argument> further) const {
  const std::size_t parts = 1 + further.size();
  std::move(further.begin(), further.end(), std::back_inserter(arguments));
  return {name(verb), std::move(arguments), parts};
}

void Builder::add_argument(std::vector<ast::Argument>& arguments, ast::Argument argument) {
  const auto amount_of = [](const ast::Argument& one) {
    return std::get_if<ast::Amount>(&one.value);
  };
  const auto* const amount = amount_of(argument);
  const ast::Argument& last = arguments.back();
  const bool has_sign = amount != nullptr && amount->value != nullptr &&
                        argument.preposition == ast::Preposition::none &&
                        std::holds_alternative<ast::Negate>(amount->value->node);
  const bool whole = last.preposition == ast::Preposition::none;
  const bool number = whole && amount_of(last) != nullptr && !amount_of(last)->times;
  if (has_sign && (number || !whole)) report_worked_out(last, argument);
  arguments.push_back(std::move(argument));
}

// `TO angle - 20deg`
void Builder::report_worked_out(const ast::Argument& first, const ast::Argument& rest) {
  Span all = between(first.span, rest.span);
  if (first.preposition != ast::Preposition::none) {
    const std::string_view text = text_of(all);
    const std::size_t word = std::min(text.find_first_of(" \t"), text.size());
    const std::size_t value = std::min(text.find_first_not_of(" \t", word), text.size());
    all.begin += static_cast<std::uint32_t>(value);
  }
  report(Code::E0505, "a calculated value needs brackets here")
      .label(all)
      .helps("write `(" + std::string(text_of(all)) + ")`");
}

// ---- parts of items

void Builder::once(ast::Box<ast::Expr>& place, ast::Box<ast::Expr> value, Span keyword) {
  if (place != nullptr) {
    report(Code::E0011, "`" + std::string(text_of(keyword)) + "` is given twice")
        .label(keyword, "again here")
        .label(place->span, "first given here", false);
  }
  place = std::move(value);
}

void Builder::add_key(std::vector<ast::MotionKey>& keys, ast::MotionKey key) {
  const bool signed_one = !keys.empty() && keys.back().value == nullptr && key.value != nullptr &&
                          keys.back().span.end == key.span.begin;
  if (!signed_one) {
    keys.push_back(std::move(key));
    return;
  }
  ast::MotionKey& sign = keys.back();
  sign.span.end = key.span.end;
  sign.value = expr(sign.span, ast::Negate{std::move(key.value)});
}

void Builder::set_priority(ast::Modifiers& modifiers, Span keyword, Span number) {
  if (modifiers.priority) {
    report(Code::E0011, "`PRIORITY` is given twice")
        .label(keyword, "again here")
        .label(modifiers.priority->span, "first given here", false);
  }
  modifiers.priority = whole_number(number);
}

void Builder::cannot_be_kept(Span kept) {
  report(Code::E0010, "only a REMEMBER can be KEPT")
      .label(kept)
      .helps("`KEPT` keeps a number: `REMEMBER visits = 0 KEPT`");
}

void Builder::set_restarting(ast::Modifiers& modifiers, Span keyword) {
  if (modifiers.restarting) report(Code::E0011, "`RESTARTING` is given twice").label(keyword);
  modifiers.restarting = true;
}

void Builder::add_part(ast::Behavior& behavior, ast::Item item) {
  if (auto* rule = std::get_if<ast::Rule>(&item.node)) {
    behavior.rules.push_back(std::move(*rule));
  } else if (auto* variable = std::get_if<ast::Remember>(&item.node)) {
    behavior.variables.push_back(std::move(*variable));
  } else {
    const auto* const use = std::get_if<ast::Use>(&item.node);
    if (use != nullptr && use->module.text.empty()) return;  // stands for a mistake
    const std::string_view text = text_of(item.span);
    const std::string keyword(text.substr(0, text.find_first_of(" \t\r\n")));
    const auto length = static_cast<std::uint32_t>(keyword.size());
    report(Code::E0010,
           "`" + keyword + "` cannot be used in a BEHAVIOR: only rules and REMEMBER can")
        .label({item.span.file, item.span.begin, item.span.begin + length})
        .helps("move it above the BEHAVIOR");
    moved_out_.push_back(std::move(item));
  }
}

ast::WhenRule Builder::when(ast::Box<ast::Expr> condition, ast::Block then_block, Span else_span,
                            ast::Block else_block) const {
  ast::WhenRule rule{std::move(condition), std::move(then_block), std::nullopt};
  const bool has_else = else_span.begin != else_span.end || !else_block.empty();
  if (has_else) rule.else_block = std::move(else_block);
  return rule;
}

ast::Block Builder::both(ast::Block first, ast::Block second) const {
  std::move(second.begin(), second.end(), std::back_inserter(first));
  return first;
}

// The analyzer loses track of who owns a pointer in a returned aggregate.
// NOLINTBEGIN(clang-analyzer-cplusplus.NewDeleteLeaks)
ast::TestFeed Builder::feed(Span at, ast::Box<ast::Expr> target, ast::Box<ast::Expr> value) {
  return {quantity(at), std::move(std::get<ast::Operand>(target->node)), std::move(value),
          std::nullopt};
}

ast::TestFeed Builder::feed_text(Span at, ast::Box<ast::Expr> target, Span text) {
  return {quantity(at), std::move(std::get<ast::Operand>(target->node)), nullptr, quoted(text)};
}
// NOLINTEND(clang-analyzer-cplusplus.NewDeleteLeaks)

}  // namespace robosync::compiler
