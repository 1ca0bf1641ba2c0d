// Builds the tree for the grammar's actions, and reports what is grammatical but not allowed.
// Without diagnostics it is silent, so that repair.cpp can try out changes.
#pragma once

#include <forward_list>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "compiler/diagnostics/diagnostic.hpp"
#include "compiler/source/source_file.hpp"
#include "compiler/syntax/ast.hpp"
#include "compiler/syntax/token.hpp"

namespace robosync::compiler {

// Help for what is nested too deeply. A LET could hold no sensor.
inline constexpr std::string_view kSimplify =
    "SET a variable to part of it in another rule, and use the variable here";

class Builder {
public:
  explicit Builder(const SourceFile& file) : file_(file) {}

  // Forgets everything and reports to `diagnostics` from now on, which may be null.
  void restart(Diagnostics* diagnostics);

  // ---- the result
  void finish(std::vector<ast::Item> items);
  void stopped(std::vector<TokenKind> expected) { expected_ = std::move(expected); }
  std::vector<ast::Item>& items() { return items_; }
  const std::vector<TokenKind>& expected() const { return expected_; }
  // The labels of everything it has built; the tree keeps them.
  std::forward_list<std::string> take_labels() { return std::move(labels_); }

  // The keywords that it has read as names, in the order of the text.
  std::vector<Span>& keyword_names() { return keyword_names_; }

  // ---- leaves
  void keyword_is_name(Span span) { keyword_names_.push_back(span); }
  ast::Name name(Span span) const;
  ast::Name quoted(Span span) const;  // without its quotes
  // `word` is the place of USE in the text, which may hold another word that a repair replaced.
  ast::Use use(Span word, ast::Use use) const;
  ast::Name longer_label(const ast::Name& label, Span next);
  ast::Name whole_number(Span span);
  ast::Box<ast::Expr> quantity(Span span);
  ast::Box<ast::Expr> operand(Span span, Span name, std::optional<Span> channel);
  ast::Box<ast::Expr> truth(Span span, bool value);

  // ---- expressions
  template <typename Node>
  ast::Box<ast::Expr> expr(Span span, Node node) {
    const std::uint16_t depth = levels(node);
    return shallow(ast::Box<ast::Expr>(new ast::Expr{span, std::move(node), depth}));
  }
  ast::Box<ast::Expr> is_between(Span span, ast::IsBetween node, bool negated);
  ast::Box<ast::Expr> times_within(Span span, ast::Box<ast::Expr> condition, Span times,
                                   ast::Box<ast::Expr> within);

  // ---- arguments
  ast::Argument word(Span span) const;
  ast::Argument text(Span span) const;
  ast::Argument amount(Span span, ast::Box<ast::Expr> value, bool times = false) const;
  // A command whose text continues after a comma.
  ast::Command command(Span verb, std::vector<ast::Argument> arguments,
                       std::vector<ast::Argument> further) const;

  // Reports a signed number that is a subtraction from the argument before it, not an argument of its own.
  void add_argument(std::vector<ast::Argument>& arguments, ast::Argument argument);

  // ---- parts of items
  // A "-" that touches the next token is its sign; any other "-" is a key of its own.
  void add_key(std::vector<ast::MotionKey>& keys, ast::MotionKey key);
  void once(ast::Box<ast::Expr>& place, ast::Box<ast::Expr> value, Span keyword);
  void set_priority(ast::Modifiers& modifiers, Span keyword, Span number);
  void cannot_be_kept(Span kept);
  void set_restarting(ast::Modifiers& modifiers, Span keyword);
  void add_part(ast::Behavior& behavior, ast::Item item);
  ast::WhenRule when(ast::Box<ast::Expr> condition, ast::Block then_block, Span else_span,
                     ast::Block else_block) const;
  ast::Block both(ast::Block first, ast::Block second) const;
  ast::TestFeed feed(Span at, ast::Box<ast::Expr> target, ast::Box<ast::Expr> value);
  ast::TestFeed feed_text(Span at, ast::Box<ast::Expr> target, Span text);

private:
  template <typename... Part>
  static std::uint16_t levels_of(const Part&... parts) {
    std::uint16_t deepest = 0;
    ((deepest = parts && parts->depth > deepest ? parts->depth : deepest), ...);
    return static_cast<std::uint16_t>(deepest + 1);
  }
  static std::uint16_t levels(const ast::Negate& n) { return levels_of(n.value); }
  static std::uint16_t levels(const ast::Arithmetic& n) { return levels_of(n.left, n.right); }
  static std::uint16_t levels(const ast::Random& n) { return levels_of(n.low, n.high); }
  static std::uint16_t levels(const ast::Function& n) { return levels_of(n.first, n.second); }
  static std::uint16_t levels(const ast::ItemOf& n) { return levels_of(n.index); }
  static std::uint16_t levels(const ast::Comparison& n) { return levels_of(n.left, n.right); }
  static std::uint16_t levels(const ast::Is& n) { return levels_of(n.value); }
  static std::uint16_t levels(const ast::IsBetween& n) { return levels_of(n.value, n.low, n.high); }
  static std::uint16_t levels(const ast::IsTruth& n) { return levels_of(n.value); }
  static std::uint16_t levels(const ast::Becomes& n) { return levels_of(n.value); }
  static std::uint16_t levels(const ast::Changes& n) { return levels_of(n.value, n.by); }
  static std::uint16_t levels(const ast::Not& n) { return levels_of(n.value); }
  static std::uint16_t levels(const ast::Logic& n) { return levels_of(n.left, n.right); }
  static std::uint16_t levels(const ast::For& n) { return levels_of(n.condition, n.duration); }
  static std::uint16_t levels(const ast::ThenWithin& n) {
    return levels_of(n.first, n.second, n.within);
  }
  static std::uint16_t levels(const ast::TimesWithin& n) {
    return levels_of(n.condition, n.within);
  }
  template <typename Leaf>
  static std::uint16_t levels(const Leaf&) {
    return 1;
  }

  ast::Box<ast::Expr> shallow(ast::Box<ast::Expr> made);
  void report_worked_out(const ast::Argument& first, const ast::Argument& rest);
  Diagnostic& report(Code code, std::string message);
  std::string_view text_of(Span span) const { return file_.text(span); }

  const SourceFile& file_;
  Diagnostics* diagnostics_ = nullptr;
  bool too_deep_ = false;  // has been reported for an expression
  Diagnostic unseen_;      // takes reports while changes are tried out
  std::vector<ast::Item> items_;
  std::vector<ast::Item> moved_out_;  // out of a BEHAVIOR, which cannot hold them
  std::vector<TokenKind> expected_;
  std::vector<Span> keyword_names_;
  std::forward_list<std::string> labels_;  // ast::Tree::labels
};

}  // namespace robosync::compiler
