// Accepts any tree of the parser, even one with mistakes. Recursion is bounded by the parser's limit on the depth of expressions.
#include "compiler/explain/conditions.hpp"

#include <optional>
#include <string_view>

#include <fmt/format.h>

#include "compiler/explain/statements.hpp"
#include "compiler/units/units.hpp"

namespace robosync::compiler::explain {
namespace {

using ast::Expr;

// ---- numbers

std::string of(const Expr& expr) {
  return number(expr);
}

// The unit's short name; as written if there is no such unit.
std::string unit_of(const ast::Quantity& quantity) {
  const Unit* const unit = find_unit(quantity.unit);
  return std::string(unit != nullptr ? unit->spelling : quantity.unit);
}

std::string_view sign(ast::ArithmeticOp op) {
  switch (op) {
    case ast::ArithmeticOp::add:
      return "+";
    case ast::ArithmeticOp::sub:
      return "-";
    case ast::ArithmeticOp::mul:
      return "*";
    case ast::ArithmeticOp::div:
      return "/";
    case ast::ArithmeticOp::mod:
      return "MOD";
  }
  return "?";
}

// Puts brackets around a sum inside another operation, so that readers need not guess the order.
std::string part(const Expr& expr) {
  const bool sum = std::holds_alternative<ast::Arithmetic>(expr.node);
  return sum ? fmt::format("({})", number(expr)) : number(expr);
}

std::string function(const ast::Function& node) {
  const std::string name = folded(node.name.text);
  const std::string first = part(*node.first);
  if (name == "abs") return "the absolute value of " + first;
  if (name == "round") return first + " rounded";
  if (!node.second) return name + " of " + first;
  const std::string both = fmt::format("{} and {}", first, part(*node.second));
  if (name == "min") return "the smaller of " + both;
  if (name == "max") return "the larger of " + both;
  return name + " of " + both;
}

std::string operand(const ast::Operand& node) {
  const std::string name(node.name.text);
  return node.channel ? fmt::format("{} {}", name, node.channel->text) : name;
}

// ---- conditions with one subject and one state

// A subject and a state, to be joined by "is", "becomes" or "has been".
struct Claim {
  std::string subject, state;
};

enum class Tense : std::uint8_t { is, becomes, has_been };

std::string_view relation_words(ast::Relation relation) {
  switch (relation) {
    case ast::Relation::less:
      return "less than";
    case ast::Relation::greater:
      return "more than";
    case ast::Relation::less_equal:
      return "at most";
    case ast::Relation::greater_equal:
      return "at least";
    case ast::Relation::equal:
      return "exactly";
    case ast::Relation::not_equal:
      return "anything but";
  }
  return "?";
}

std::optional<Claim> claim(const Expr& expr) {
  if (const auto* node = std::get_if<ast::Comparison>(&expr.node)) {
    return Claim{of(*node->left),
                 fmt::format("{} {}", relation_words(node->relation), of(*node->right))};
  }
  if (const auto* node = std::get_if<ast::Is>(&expr.node)) {
    const std::string_view quote = node->is_string ? "\"" : "";
    const std::string label = fmt::format("{0}{1}{0}", quote, node->label.text);
    return Claim{of(*node->value), (node->negated ? "anything but " : "") + label};
  }
  if (const auto* node = std::get_if<ast::IsBetween>(&expr.node)) {
    return Claim{of(*node->value),
                 fmt::format("between {} and {}", of(*node->low), of(*node->high))};
  }
  if (const auto* node = std::get_if<ast::IsTruth>(&expr.node)) {
    return Claim{node->value ? of(*node->value) : "it", node->truth ? "true" : "false"};
  }
  if (const auto* node = std::get_if<ast::Operand>(&expr.node)) {
    return Claim{operand(*node), "true"};
  }
  return std::nullopt;
}

std::string say(const Claim& claim, Tense tense, bool negated) {
  switch (tense) {
    case Tense::is:
      return fmt::format("{} is {}{}", claim.subject, negated ? "not " : "", claim.state);
    case Tense::becomes:
      return fmt::format("{} {} {}", claim.subject, negated ? "stops being" : "becomes",
                         claim.state);
    case Tense::has_been:
      return fmt::format("{} has {}been {}", claim.subject, negated ? "not " : "", claim.state);
  }
  return {};
}

// A condition as a single clause; nullopt if it has several parts.
std::optional<std::string> simple(const Expr& expr, Tense tense) {
  if (const auto one = claim(expr)) return say(*one, tense, false);
  if (const auto* node = std::get_if<ast::Not>(&expr.node)) {
    if (const auto one = claim(*node->value)) return say(*one, tense, true);
  }
  return std::nullopt;
}

// ---- conditions of every kind

std::string changes(const ast::Changes& node) {
  std::string text = of(*node.value) + " changes";
  if (node.by) text += fmt::format(" by {} or more", of(*node.by));
  return text;
}

// An event at one moment: "touch LEVEL becomes more than 0".
std::string moment(const Expr& expr) {
  if (const auto one = simple(expr, Tense::becomes)) return *one;
  if (const auto* node = std::get_if<ast::Becomes>(&expr.node)) {
    return fmt::format("{} becomes {}", of(*node->value), node->label.text);
  }
  if (const auto* node = std::get_if<ast::Changes>(&expr.node)) return changes(*node);
  return fmt::format("it becomes true that {}", is_true(expr));
}

std::string held(const ast::For& node) {
  const std::string time = of(*node.duration);
  if (const auto one = simple(*node.condition, Tense::has_been)) {
    return fmt::format("{} for {} without a break", *one, time);
  }
  return fmt::format("it has been true for {} without a break that {}", time,
                     is_true(*node.condition));
}

std::string_view ordinal_ending(std::uint32_t number) {
  constexpr std::uint32_t kTen = 10;
  constexpr std::uint32_t kHundred = 100;
  if (number % kHundred / kTen == 1) return "th";
  switch (number % kTen) {
    case 1:
      return "st";
    case 2:
      return "nd";
    case 3:
      return "rd";
    default:
      return "th";
  }
}

std::optional<std::string> time_word(const Expr& expr) {
  if (const auto* node = std::get_if<ast::For>(&expr.node)) return held(*node);
  if (const auto* node = std::get_if<ast::ThenWithin>(&expr.node)) {
    return fmt::format("{} and then, at most {} later, {}", moment(*node->first), of(*node->within),
                       moment(*node->second));
  }
  if (const auto* node = std::get_if<ast::TimesWithin>(&expr.node)) {
    return fmt::format("{} for the {}{} time within {}", moment(*node->condition), node->times,
                       ordinal_ending(node->times), of(*node->within));
  }
  return std::nullopt;
}

// A part of AND or OR, in brackets if it is the other of the two.
std::string part_of_logic(const Expr& expr, ast::LogicOp op) {
  const auto* const inner = std::get_if<ast::Logic>(&expr.node);
  const bool brackets = (inner != nullptr && inner->op != op) || time_word(expr).has_value();
  return brackets ? fmt::format("({})", is_true(expr)) : is_true(expr);
}

std::string no_number(const Expr& expr) {
  return fmt::format("({})", is_true(expr));
}

}  // namespace

std::string number(const Expr& expr) {
  if (const auto* node = std::get_if<ast::Quantity>(&expr.node))
    return std::string(node->digits) + unit_of(*node);
  if (const auto* node = std::get_if<ast::Operand>(&expr.node)) return operand(*node);
  if (const auto* node = std::get_if<ast::Negate>(&expr.node)) return "-" + part(*node->value);
  if (const auto* node = std::get_if<ast::Arithmetic>(&expr.node)) {
    return fmt::format("{} {} {}", part(*node->left), sign(node->op), part(*node->right));
  }
  if (const auto* node = std::get_if<ast::Random>(&expr.node)) {
    return fmt::format("a random number from {} to {}", of(*node->low), of(*node->high));
  }
  if (const auto* node = std::get_if<ast::ItemOf>(&expr.node))
    return fmt::format("item {} of {}", part(*node->index), node->list.text);
  if (const auto* node = std::get_if<ast::CountOf>(&expr.node))
    return fmt::format("the number of items in {}", node->list.text);
  if (const auto* node = std::get_if<ast::Function>(&expr.node)) return function(*node);
  return no_number(expr);
}

std::string is_true(const Expr& expr) {
  if (const auto one = simple(expr, Tense::is)) return *one;
  if (const auto word = time_word(expr)) return *word;
  if (const auto* node = std::get_if<ast::Logic>(&expr.node)) {
    return fmt::format("{} {} {}", part_of_logic(*node->left, node->op),
                       node->op == ast::LogicOp::and_ ? "and" : "or",
                       part_of_logic(*node->right, node->op));
  }
  if (const auto* node = std::get_if<ast::Not>(&expr.node)) {
    return fmt::format("it is not true that ({})", is_true(*node->value));
  }
  if (const auto* node = std::get_if<ast::Becomes>(&expr.node)) {
    return fmt::format("{} has just become {}", of(*node->value), node->label.text);
  }
  if (const auto* node = std::get_if<ast::Changes>(&expr.node)) return changes(*node);
  return number(expr) + " is true";  // a mistake that `rsc check` reports
}

std::string as_soon_as(const Expr& condition) {
  const auto word = time_word(condition);
  return "As soon as " + (word ? *word : moment(condition));
}

std::string while_true(const Expr& condition) {
  if (const auto one = simple(condition, Tense::is)) return "While " + *one;
  if (const auto word = time_word(condition)) return "While " + *word;
  return "While it is true that " + is_true(condition);
}

}  // namespace robosync::compiler::explain
