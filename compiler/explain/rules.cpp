// Accepts any tree of the parser.
#include "compiler/explain/rules.hpp"

#include <fmt/format.h>

#include "compiler/explain/conditions.hpp"

namespace robosync::compiler::explain {
namespace {

constexpr std::size_t kRuleIndent = 2;

class RuleText {
public:
  RuleText(const Defines& defines, std::string_view place, std::size_t indent)
      : defines_(defines), place_(place), indent_(indent) {}

  void write(const ast::WhenRule& rule) {
    see(*rule.condition);
    title(as_soon_as(*rule.condition));
    body(rule.then_block);
    if (!rule.else_block) return;
    say(0, "As soon as that is no longer true:");
    body(*rule.else_block);
    has_else_ = true;
    say(kRuleIndent,
        "Each side interrupts the other. At start, the side that applies runs once, as soon "
        "as that is known.");
    say(kRuleIndent,
        "If something more important is using what a side needs, that side runs as soon as "
        "all of it is free, if it still applies.");
  }
  void write(const ast::WhileRule& rule) {
    see(*rule.condition);
    title(while_true(*rule.condition));
    body(rule.body);
    say(kRuleIndent,
        "It stops immediately when that is no longer true. If it finishes before that, it "
        "starts again from the top.");
  }
  void write(const ast::EveryRule& rule) {
    title(rule.to ? fmt::format("Every {} to {}, at random", number(*rule.period), number(*rule.to))
                  : fmt::format("Every {}", number(*rule.period)));
    body(rule.body);
    say(kRuleIndent, "If it is still running when its time comes, that time is skipped.");
  }
  void write(const ast::AtStartRule& rule) {
    title("Once, when the program starts");
    body(rule.body);
  }

  void write(const ast::Modifiers& modifiers) {
    if (modifiers.margin) {
      say(kRuleIndent,
          fmt::format("{}nce true, {}stays true until the value is {} back past its "
                      "limit, so that it does not flicker{}.",
                      one_comparison_ ? "O" : "Each comparison in it with this kind of unit, o",
                      one_comparison_ ? "it " : "", number(*modifiers.margin),
                      has_not_ ? "; NOT reverses the result" : ""));
    }
    if (modifiers.cooldown) {
      say(kRuleIndent, fmt::format("After {} has started, {} does not start again for {}.",
                                   has_else_ ? "a side" : "it", has_else_ ? "that side" : "it",
                                   number(*modifiers.cooldown)));
    }
    if (modifiers.restarting) {
      say(kRuleIndent,
          "If it becomes true again while this is still running, it starts again from "
          "the top.");
    }
    if (modifiers.waiting && !has_else_) {  // a rule with ELSE always waits, for any time
      say(kRuleIndent,
          fmt::format("If something more important is using what it needs, it waits for "
                      "at most {}.",
                      number(*modifiers.waiting)));
    }
  }

  void write(const ast::Safety& safety) {
    see(*safety.condition);
    const std::string condition = while_true(*safety.condition);
    say(0, fmt::format("{}, or while that is unknown:", condition));
    body(safety.body);
    write(safety.modifiers);
    say(0, safety.resume ? fmt::format("It lets go {}.", lower_first(as_soon_as(*safety.resume)))
                         : "It does not let go on its own: a person must do that from the host.");
  }

  std::string text;

private:
  void see(const ast::Expr& condition) {
    const auto* const held = std::get_if<ast::For>(&condition.node);
    const auto& node = (held != nullptr ? *held->condition : condition).node;
    one_comparison_ = std::holds_alternative<ast::Comparison>(node) ||
                      std::holds_alternative<ast::IsBetween>(node);
    has_not_ = has_not(condition);
  }
  static bool has_not(const ast::Expr& condition) {
    if (const auto* const held = std::get_if<ast::For>(&condition.node))
      return has_not(*held->condition);
    const auto* const both = std::get_if<ast::Logic>(&condition.node);
    if (both != nullptr) return has_not(*both->left) || has_not(*both->right);
    return std::holds_alternative<ast::Not>(condition.node);
  }
  static std::string lower_first(std::string words) {
    if (!words.empty() && words.front() == 'A') words.front() = 'a';
    return words;
  }
  void say(std::size_t more, std::string_view words) {
    text += fmt::format("{:{}}{}\n", "", indent_ + more, words);
  }
  void title(std::string_view words) { say(0, fmt::format("{} ({}):", words, place_)); }
  void body(const ast::Block& block) { text += statements(block, defines_, indent_ + kRuleIndent); }

  const Defines& defines_;
  std::string_view place_;
  std::size_t indent_;
  bool has_else_ = false;
  bool one_comparison_ = false;  // the condition consists of this, apart from its FOR
  bool has_not_ = false;
};

}  // namespace

std::string rule_text(const ast::Rule& rule, std::string_view place, const Defines& defines,
                      std::size_t indent) {
  RuleText writer(defines, place, indent);
  std::visit([&](const auto& node) { writer.write(node); }, rule.node);
  writer.write(rule.modifiers);
  return std::move(writer.text);
}

std::string safety_text(const ast::Safety& safety, const Defines& defines, std::size_t indent) {
  RuleText writer(defines, "", indent);
  writer.write(safety);
  return std::move(writer.text);
}

}  // namespace robosync::compiler::explain
