// See foreign_ranges.hpp.
#include "compiler/syntax/foreign_ranges.hpp"

#include <algorithm>
#include <optional>
#include <string>
#include <string_view>

#include <fmt/format.h>

#include "compiler/source/ascii.hpp"
#include "compiler/syntax/rewritten.hpp"
#include "compiler/units/units.hpp"

namespace robosync::compiler {
namespace {

constexpr std::string_view kDots = "..";

class ForeignRange {
public:
  ForeignRange(const Tokens& tokens, std::size_t at, const SourceFile& source)
      : tokens_(tokens), source_(source), begin_(at), end_(at) {}

  // True if one begins here, behind what it is about.
  [[nodiscard]] bool read() {
    const bool is_written = take(Kinds::IS);
    negated_ = take(Kinds::NOT);
    const bool between = take(Kinds::BETWEEN);
    const bool in = !between && take_in();
    if (!between && !in && !is_written && !take(Kinds::WITHIN) && !take(Kinds::EQUAL)) return false;
    const bool open = take(Kinds::OPEN) || is_behind_square();
    const bool lacks_is_only = !negated_ || is_written;
    return take_numbers(between && !open && lacks_is_only, between || in) &&
           (!open || take(Kinds::CLOSE) || is_behind_square());
  }

  [[nodiscard]] std::size_t end() const { return end_; }

  // With the bracket that the lexer has left out.
  [[nodiscard]] Span place() const {
    Span all = tokens_[begin_].span;
    all.end = tokens_[end_ - 1].span.end;
    if (source_.text().substr(all.end, 1) == "]") ++all.end;
    return all;
  }

  [[nodiscard]] std::string rule() const {
    return fmt::format("{0}between two numbers is written `IS {1}BETWEEN … AND …`",
                       negated_ ? "not " : "", negated_ ? "NOT " : "");
  }
  [[nodiscard]] std::string better() const {
    return fmt::format("IS {}BETWEEN {}{} AND {}", negated_ ? "NOT " : "", text(first_),
                       has_unit(first_) ? "" : unit(last_), text(last_));
  }

  void add_tokens(Tokens& into) const {
    const Span at = tokens_[begin_].span;
    into.push_back({Kinds::IS, at});
    if (negated_) into.push_back({Kinds::NOT, at});
    into.push_back({Kinds::BETWEEN, at});
    add_number(has_unit(first_) ? first_ : last_, into);  // `2` of `2..5cm` has the unit of `5cm`
    into.push_back({Kinds::AND, at});
    add_number(last_, into);
  }

private:
  struct Number {
    bool negative = false;
    Span span;
  };

  [[nodiscard]] bool is(TokenKind kind) const {
    return end_ < tokens_.size() && tokens_[end_].kind == kind;
  }
  bool take(TokenKind kind) {
    const bool there = is(kind);
    if (there) ++end_;
    return there;
  }
  bool take_word(std::string_view word) {
    if (!is(Kinds::NAME) || !ascii::same(source_.text(tokens_[end_].span), word)) return false;
    ++end_;
    return true;
  }
  // `IN RANGE`, `FROM`, `OUTSIDE OF`
  bool take_in() {
    if (take_word("OUTSIDE")) {
      negated_ = !negated_;
      take(Kinds::OF);
      return true;
    }
    if (!take_word("IN") && !take_word("INSIDE") && !take(Kinds::FROM)) return false;
    take_word("RANGE");
    return true;
  }
  // The lexer leaves `[` and `]` out.
  [[nodiscard]] bool is_behind_square() const {
    if (end_ == tokens_.size() || tokens_[end_].span.begin < tokens_[end_ - 1].span.end)
      return false;
    const std::uint32_t from = tokens_[end_ - 1].span.end, to = tokens_[end_].span.begin;
    return source_.text().substr(from, to - from).find_first_of("[]") != std::string_view::npos;
  }

  // `right`: `BETWEEN 2 AND 5` is no mistake, or lacks its IS only. `any_sign`: the word before them leaves no doubt that this is a range.
  bool take_numbers(bool right, bool any_sign) {
    const auto number = take_number();
    if (!number) return false;
    if (split(*number)) return true;
    first_ = *number;
    const bool both = any_sign && take(Kinds::AND);
    const bool minus = !both && any_sign && take(Kinds::MINUS);
    if (!both && !minus && !take(Kinds::TO) && !(any_sign && take(Kinds::COMMA))) return false;
    const auto other = take_number();
    if (!other || (both && right) || (minus && is(Kinds::AND))) return false;
    last_ = *other;
    return true;
  }

  std::optional<Number> take_number() {
    const bool negative = take(Kinds::MINUS);
    if (!is(Kinds::QUANTITY)) return std::nullopt;
    return Number{negative, tokens_[end_++].span};
  }

  // `2..5`, which the lexer takes for one number.
  bool split(const Number& number) {
    const std::string_view both = source_.text(number.span);
    const std::size_t dots = both.find(kDots);
    const std::size_t behind = both.find_first_not_of('.', dots);
    if (dots == 0 || dots == std::string_view::npos || behind == std::string_view::npos)
      return false;
    first_ = last_ = number;
    first_.span.end = number.span.begin + static_cast<std::uint32_t>(dots);
    last_.negative = false;
    last_.span.begin += static_cast<std::uint32_t>(behind);
    return true;
  }

  [[nodiscard]] std::string_view unit(const Number& number) const {
    return written_unit(source_.text(number.span));
  }
  [[nodiscard]] bool has_unit(const Number& number) const { return !unit(number).empty(); }
  [[nodiscard]] std::string text(const Number& number) const {
    return (number.negative ? "-" : "") + std::string(source_.text(number.span));
  }
  static void add_number(const Number& number, Tokens& into) {
    if (number.negative) into.push_back({Kinds::MINUS, number.span});
    into.push_back({Kinds::QUANTITY, number.span});
  }

  const Tokens& tokens_;
  const SourceFile& source_;
  std::size_t begin_, end_;
  bool negated_ = false;
  Number first_, last_;
};

// Does a condition go on behind the token? `asked`: it did before.
bool asks_after(const Tokens& tokens, std::size_t at, bool asked) {
  const auto combines = [&tokens](std::size_t place) {
    return place < tokens.size() && is_one_of(tokens[place].kind, {Kinds::AND, Kinds::OR});
  };
  if (begins_question(tokens[at].kind)) return true;
  if (!asked || is_one_of(tokens[at].kind, {Kinds::DO, Kinds::THEN, Kinds::END})) return false;
  return tokens[at].kind != Kinds::NEWLINE || combines(at - 1) || combines(at + 1) ||
         begins_question(tokens[at - 1].kind);
}

}  // namespace

std::vector<Span> mend_foreign_ranges(Tokens& tokens, const SourceFile& source,
                                      Diagnostics& diagnostics) {
  std::vector<Span> places;
  Rewritten rewritten(tokens);
  bool asked = false;
  for (std::size_t at = 0; at < tokens.size(); ++at) {
    const TokenKind kind = tokens[at].kind;
    const bool behind_value =
        asked && at > 0 && is_one_of(tokens[at - 1].kind, {Kinds::NAME, Kinds::CLOSE});
    ForeignRange range(tokens, at, source);
    if (!behind_value || !range.read()) {
      if (is_keyword(kind) || kind == Kinds::NEWLINE) asked = asks_after(tokens, at, asked);
      rewritten.keep(at);
      continue;
    }
    diagnostics.report(Code::E0001, range.rule())
        .label(range.place())
        .helps("write `" + range.better() + "`")
        .fix(range.place(), range.better(), Applicability::likely);
    places.push_back(range.place());
    range.add_tokens(rewritten.other(at));
    at = range.end() - 1;
  }
  rewritten.finish();
  return places;
}

}  // namespace robosync::compiler
