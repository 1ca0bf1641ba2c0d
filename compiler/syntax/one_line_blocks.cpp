// See one_line_blocks.hpp.
#include "compiler/syntax/one_line_blocks.hpp"

#include <algorithm>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "compiler/source/ascii.hpp"
#include "compiler/source/sorting.hpp"
#include "compiler/syntax/blocks.hpp"
#include "compiler/syntax/condition_behind.hpp"
#include "compiler/syntax/keyword_roles.hpp"
#include "compiler/syntax/rewritten.hpp"
#include "compiler/syntax/word_list.hpp"

namespace robosync::compiler {
namespace {

constexpr std::string_view kPrints = "PRINT PRINTLN PRINTF LOG";

// A statement as RSL writes it.
struct Statement {
  Tokens tokens;
  std::string text;
  bool changed = false;
  Span sign{};  // what another language has there
};

class OneLineBlock {
public:
  OneLineBlock(const Tokens& tokens, const SourceFile& source, const Diagnostics& said,
               TokenRange line, bool is_outside)
      : tokens_(tokens), source_(source), said_(said), line_(line), is_outside_(is_outside) {}

  // Has it several habits, and nothing that is unknown in RSL?
  [[nodiscard]] bool read() {
    then_ = line_.begin + 1;
    // `WHEN a THEN b WITHIN 5s` asks for one after the other.
    const bool may_say_then = is(line_.begin, Kinds::IF) || !says_within();
    while (then_ < line_.end && !is(then_, Kinds::DO) && !(may_say_then && is(then_, Kinds::THEN)))
      ++then_;
    if (then_ == line_.end) then_ = comma();
    closed_ = is(line_.end - 1, Kinds::END);
    const TokenRange body{then_ + 1, closed_ ? line_.end - 1 : line_.end};
    if (then_ == line_.begin + 1 || body.begin >= body.end || !(closed_ || is_basic()))
      return false;
    std::size_t other = body.begin;
    while (other < body.end && !is(other, Kinds::ELSE))
      ++other;
    if (!read_statements({body.begin, other}, main_)) return false;
    const std::size_t behind = is(other + 1, Kinds::DO) ? other + 2 : other + 1;  // `else {`
    if (other < body.end && !read_statements({behind, body.end}, else_)) return false;
    return has_several_habits();
  }

  [[nodiscard]] bool says_within() const {
    std::size_t at = line_.begin;
    while (at < line_.end && !is(at, Kinds::WITHIN))
      ++at;
    return at < line_.end;
  }

  void report(Diagnostics& diagnostics) const {
    Diagnostic& message =
        diagnostics.report(Code::E0001, "this line is written as in other languages, not in RSL");
    bool first = true;
    const auto mark = [&](Span place, const std::string& why) {
      message.label(place, why, std::exchange(first, false));
    };
    if (is_rule()) mark(tokens_[line_.begin].span, "a rule begins with `WHEN`");
    if (is_foreign_do()) mark(tokens_[then_].span, "a block begins with `DO` and ends with `END`");
    if (const Statement* const changed = first_changed())
      mark(changed->sign, fmt::format("write `{}`", changed->text));
    else if (first)
      mark(span(line_), "");
    if (is_short())
      message.helps("write `" + short_text() + "`");
    else
      message.helps(fmt::format(
          "write `{} {} DO`, then each command on a line of its own, such as `{}`, then `END`",
          word(), condition(), main_.front().text));
    message.fix(span(line_), is_short() ? short_text() : long_text(), Applicability::likely);
  }

  void add_to(Tokens& tokens) const {
    Token first = tokens_[line_.begin];
    if (is_rule()) first.kind = Kinds::WHEN;
    tokens.push_back(first);
    const TokenRange asked = asked_for();
    for (std::size_t at = asked.begin; at < asked.end; ++at)
      tokens.push_back(tokens_[at]);
    tokens.push_back({Kinds::DO, tokens_[then_].span});
    add(main_, tokens);
    if (!else_.empty()) tokens.push_back(missing(Kinds::ELSE));
    add(else_, tokens);
    tokens.push_back(closed_ ? tokens_[line_.end - 1] : missing(Kinds::END));
  }

  [[nodiscard]] Span place() const { return span(line_); }

private:
  [[nodiscard]] bool is(std::size_t at, TokenKind kind) const {
    return at < tokens_.size() && tokens_[at].kind == kind;
  }
  [[nodiscard]] std::string_view text(std::size_t at) const {
    return source_.text(tokens_[at].span);
  }
  [[nodiscard]] Span span(TokenRange range) const {
    Span all = tokens_[range.begin].span;
    all.end = std::max(all.end, tokens_[range.end - 1].span.end);
    return all;
  }
  [[nodiscard]] Token missing(TokenKind kind) const {
    const std::uint32_t end = tokens_[line_.end - 1].span.end;
    return {kind, {tokens_.front().span.file, end, end}};
  }

  // ---- the line

  // `WHEN x > 3, SHOW face happy`
  [[nodiscard]] std::size_t comma() const {
    int open = 0;
    for (std::size_t at = line_.begin; at < line_.end; ++at) {
      open += is(at, Kinds::OPEN) ? 1 : is(at, Kinds::CLOSE) ? -1 : 0;
      if (open == 0 && is(at, Kinds::COMMA)) return at;
    }
    return line_.end;
  }
  // `IF x > 3 THEN y = 5`, `IF x > 3, SHOW face happy`, without an END on the next line, either.
  [[nodiscard]] bool is_basic() const {
    if (!is(then_, Kinds::THEN) && !is(then_, Kinds::COMMA)) return false;
    std::size_t next = line_.end;
    while (is(next, Kinds::NEWLINE))
      ++next;
    if (next == tokens_.size()) return true;
    if (!is(next, Kinds::END)) return (roles_of(tokens_[next].kind) & role::after) == 0;
    return indentation(tokens_[next], source_) < indentation(tokens_[line_.begin], source_);
  }
  [[nodiscard]] bool is_rule() const { return is_outside_ && is(line_.begin, Kinds::IF); }
  [[nodiscard]] bool is_foreign_do() const { return !ascii::same(text(then_), "DO"); }
  [[nodiscard]] const char* word() const {
    return is_rule() || is(line_.begin, Kinds::WHEN) ? "WHEN" : "IF";
  }

  // Without the brackets around all of it.
  [[nodiscard]] TokenRange asked_for() const {
    const TokenRange all{line_.begin + 1, then_};
    if (!is(all.begin, Kinds::OPEN) || !is(all.end - 1, Kinds::CLOSE)) return all;
    int open = 0;
    for (std::size_t at = all.begin; at + 1 < all.end; ++at) {
      open += is(at, Kinds::OPEN) ? 1 : is(at, Kinds::CLOSE) ? -1 : 0;
      if (open == 0) return all;
    }
    return all.begin + 2 < all.end ? TokenRange{all.begin + 1, all.end - 1} : all;
  }
  [[nodiscard]] std::string condition() const { return mended_text(asked_for()); }

  // What the lexer says about a place in the line, but for braces and semicolons.
  [[nodiscard]] std::ptrdiff_t lexical_habits() const {
    return std::ranges::count_if(
        said_.all(), [this](const Diagnostic& one) { return is_here(one) && !one.fixes.empty(); });
  }
  [[nodiscard]] bool is_here(const Diagnostic& one) const {
    const Span line = span(line_), place = one.labels.front().span;
    return line.begin <= place.begin && place.begin < line.end;
  }

  // Signs alone, such as `&&`, have their own messages, whose fixes are certain.
  [[nodiscard]] bool has_several_habits() const {
    const int of_line =
        int{is_rule()} + int{is_foreign_do()} + int{!closed_} + int{first_changed() != nullptr};
    return of_line > 1 || (of_line == 1 && lexical_habits() > 0);
  }

  // The source text, with the fixes of the lexer.
  [[nodiscard]] std::string mended_text(TokenRange range) const {
    const Span all = span(range);
    std::string mended(source_.text(all));
    std::vector<Fix> fixes;
    for (const Diagnostic& one : said_.all())
      for (const Fix& fix : one.fixes)
        if (all.begin <= fix.span.begin && fix.span.end <= all.end) fixes.push_back(fix);
    sort_stably(fixes, std::ranges::greater{}, [](const Fix& fix) { return fix.span.begin; });
    for (const Fix& fix : fixes)
      mended.replace(fix.span.begin - all.begin, fix.span.end - fix.span.begin, fix.replacement);
    return mended;
  }

  // ---- statements

  [[nodiscard]] bool read_statements(TokenRange range, std::vector<Statement>& into) const {
    while (range.begin < range.end) {
      std::size_t end = range.begin + 1;
      while (end < range.end && !ends_with_semicolon(end - 1))
        ++end;
      auto one = statement({range.begin, end});
      if (!one) return false;
      into.push_back(std::move(*one));
      range.begin = end;
    }
    return !into.empty();
  }
  [[nodiscard]] bool ends_with_semicolon(std::size_t at) const {
    const std::uint32_t end = tokens_[at].span.end;
    return source_.text().substr(end, tokens_[at + 1].span.begin - end).find(';') !=
           std::string_view::npos;
  }

  [[nodiscard]] bool opens_block(std::size_t at) const {
    return (roles_of(tokens_[at].kind) & role::opens) != 0 && !is(at, Kinds::AT);
  }

  [[nodiscard]] std::optional<Statement> statement(TokenRange range) const {
    for (std::size_t at = range.begin; at < range.end; ++at)
      if (opens_block(at)) return std::nullopt;
    if (auto changed = assignment(range)) return changed;
    if (auto printed = print(range)) return printed;
    const bool is_call = is(range.begin + 1, Kinds::OPEN) && range.begin + 1 < range.end &&
                         tokens_[range.begin].span.end == tokens_[range.begin + 1].span.begin;
    for (std::size_t at = range.begin; at < range.end; ++at)
      if (is_relation(tokens_[at].kind) || is(at, Kinds::IS) || is(at, Kinds::WITHIN))
        return std::nullopt;
    const bool begins = is(range.begin, Kinds::NAME) ||
                        (roles_of(tokens_[range.begin].kind) & role::statement) != 0;
    if (is_call || !begins) return std::nullopt;
    return Statement{tokens_of(range), mended_text(range)};
  }

  [[nodiscard]] Tokens tokens_of(TokenRange range) const {
    return {tokens_.begin() + static_cast<std::ptrdiff_t>(range.begin),
            tokens_.begin() + static_cast<std::ptrdiff_t>(range.end)};
  }

  // `y = 5`, `y += 1`, `y++`
  [[nodiscard]] std::optional<Statement> assignment(TokenRange range) const {
    const std::size_t sign = range.begin + 1;
    if (!is(range.begin, Kinds::NAME) || sign >= range.end) return std::nullopt;
    if (is(sign, Kinds::EQUAL)) return assignment("SET", "TO", range, sign + 1);
    if (!is(sign, Kinds::PLUS) && !is(sign, Kinds::MINUS)) return std::nullopt;
    const char* const verb = is(sign, Kinds::PLUS) ? "RAISE" : "LOWER";
    if (is(sign + 1, Kinds::EQUAL)) return assignment(verb, "BY", range, sign + 2);
    const bool twice = range.end == sign + 2 && tokens_[sign].kind == tokens_[sign + 1].kind;
    return twice ? assignment(verb, "BY", range, sign + 2) : std::nullopt;
  }
  [[nodiscard]] std::optional<Statement> assignment(std::string_view verb,
                                                    std::string_view preposition, TokenRange range,
                                                    std::size_t value) const {
    const Token name = tokens_[range.begin];
    const bool counts = value == range.end, sets = verb == "SET";
    if (counts && sets) return std::nullopt;
    const Span sign = span({range.begin + 1, value});
    const Span before{name.span.file, name.span.begin, name.span.begin};
    Statement one{
        {{find_keyword(verb)->kind, before}, name, {find_keyword(preposition)->kind, sign}},
        fmt::format("{} {} {} {}", verb, text(range.begin), preposition,
                    counts ? "1" : mended_text({value, range.end})),
        true,
        sign};
    if (counts) one.tokens.push_back({Kinds::QUANTITY, sign});
    const Tokens values = tokens_of({value, range.end});
    one.tokens.insert(one.tokens.end(), values.begin(), values.end());
    return one;
  }

  // `PRINT "hi"`, `print("hi")`
  [[nodiscard]] std::optional<Statement> print(TokenRange range) const {
    if (!is(range.begin, Kinds::NAME) || !has_word(kPrints, text(range.begin))) return std::nullopt;
    const bool brackets = is(range.begin + 1, Kinds::OPEN);
    const std::size_t said = range.begin + (brackets ? 2 : 1);
    if (!is(said, Kinds::STRING) || said + (brackets ? 2 : 1) != range.end) return std::nullopt;
    return Statement{{{Kinds::LOG, tokens_[range.begin].span}, tokens_[said]},
                     fmt::format("LOG {}", text(said)),
                     true,
                     tokens_[range.begin].span};
  }

  [[nodiscard]] const Statement* first_changed() const {
    for (const auto* const part : {&main_, &else_})
      for (const Statement& one : *part)
        if (one.changed) return &one;
    return nullptr;
  }

  // ---- as RSL writes it

  [[nodiscard]] bool is_short() const { return main_.size() == 1 && else_.size() <= 1; }
  [[nodiscard]] std::string short_text() const {
    const std::string other = else_.empty() ? "" : " ELSE " + else_.front().text;
    return fmt::format("{} {} DO {}{} END", word(), condition(), main_.front().text, other);
  }
  [[nodiscard]] std::string long_text() const {
    const std::string end = "\n" + std::string(indentation(tokens_[line_.begin], source_), ' ');
    std::string all = fmt::format("{} {} DO", word(), condition());
    for (const Statement& one : main_)
      all += end + "  " + one.text;
    if (!else_.empty()) all += end + "ELSE";
    for (const Statement& one : else_)
      all += end + "  " + one.text;
    return all + end + "END";
  }
  void add(const std::vector<Statement>& statements, Tokens& tokens) const {
    for (const Statement& one : statements) {
      tokens.push_back({Kinds::NEWLINE,
                        {one.tokens.front().span.file, one.tokens.front().span.begin,
                         one.tokens.front().span.begin}});
      tokens.insert(tokens.end(), one.tokens.begin(), one.tokens.end());
    }
    if (!statements.empty()) tokens.push_back(missing(Kinds::NEWLINE));
  }

  const Tokens& tokens_;
  const SourceFile& source_;
  const Diagnostics& said_;
  TokenRange line_;
  bool is_outside_;
  std::size_t then_ = 0;
  bool closed_ = false;
  std::vector<Statement> main_, else_;
};

}  // namespace

std::vector<Span> mend_one_line_blocks(Tokens& tokens, const SourceFile& source,
                                       const Diagnostics& said, Diagnostics& diagnostics) {
  std::vector<Span> places;
  Rewritten rewritten(tokens);
  BlockWalk walk(tokens);
  for (std::size_t at = 0; at < tokens.size();) {
    std::size_t end = at;
    while (end < tokens.size() && tokens[end].kind != Kinds::NEWLINE)
      ++end;
    const TokenKind block =
        walk.open().empty() ? TokenKind(Kinds::BEHAVIOR) : tokens[walk.open().back()].kind;
    const bool outside = block == Kinds::BEHAVIOR;
    OneLineBlock line(tokens, source, said, {at, end}, outside);
    if (is_one_of(tokens[at].kind, {Kinds::IF, Kinds::WHEN}) && line.read()) {
      line.report(diagnostics);
      line.add_to(rewritten.other(at));
      places.push_back(line.place());
      at = end;
    } else if (!outside && block != Kinds::TEST && block != Kinds::SAFETY) {
      const Tokens mended = condition_first(tokens, {at, end}, source, diagnostics);
      if (!mended.empty()) {
        Tokens& into = rewritten.other(at);
        into.insert(into.end(), mended.begin(), mended.end());
        at = end;
      }
    }
    for (; at < std::min(end + 1, tokens.size()); ++at) {
      walk.step(at);
      rewritten.keep(at);
    }
  }
  rewritten.finish();
  return places;
}

}  // namespace robosync::compiler
