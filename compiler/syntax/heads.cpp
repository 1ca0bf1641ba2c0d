// See heads.hpp.
#include "compiler/syntax/heads.hpp"

#include <algorithm>
#include <initializer_list>
#include <string>

#include "compiler/source/ascii.hpp"
#include "compiler/syntax/blocks.hpp"
#include "compiler/syntax/keyword_roles.hpp"

namespace robosync::compiler {

namespace {

// The head ends at the end of its line, or where a rule begins in the same line.
bool ends_head(TokenKind kind) {
  return kind == Kinds::NEWLINE || kind == Kinds::WHEN || kind == Kinds::WHILE ||
         kind == Kinds::EVERY || kind == Kinds::AT;
}

bool is_misplaced(TokenKind kind) {
  return kind == Kinds::END || kind == Kinds::BEHAVIOR;
}

void report(const Token& token, const Token& name, const SourceFile& source,
            Diagnostics& diagnostics) {
  const bool named = name.kind == Kinds::NAME;
  diagnostics
      .report(Code::E0010, "`" + std::string(source.text(token.span)) +
                               "` does not belong in the first line of a BEHAVIOR")
      .label(token.span)
      .helps("write `BEHAVIOR " + std::string(named ? source.text(name.span) : "name") +
             " PRIORITY 50`, then its rules, then `END`");
}

// Does a rule of the BEHAVIOR follow its head, which ends at `end`?
bool rule_follows(const Tokens& tokens, std::size_t end) {
  while (end < tokens.size() && tokens[end].kind == Kinds::NEWLINE)
    ++end;
  return end < tokens.size() && (roles_of(tokens[end].kind) & role::item) == 0;
}

}  // namespace

namespace {

// True when `behind` can follow the name in a declaration that begins with `first`.
bool declares(TokenKind first, TokenKind behind) {
  switch (first) {
    case Kinds::REMEMBER:
    case Kinds::LET:
      return behind == Kinds::EQUAL;
    case Kinds::STATE:
    case Kinds::LIST:
      return behind == Kinds::COLON;
    case Kinds::FEELING:
      return behind == Kinds::FROM;
    case Kinds::TIMER:
    case Kinds::DEFINE:
      return behind == Kinds::NEWLINE || behind == Kinds::WITH;
    case Kinds::CHECK:
    case Kinds::MOTION:
      return behind == Kinds::OF;
    default:
      return false;
  }
}

bool are(const Tokens& tokens, std::size_t at, std::initializer_list<TokenKind> kinds) {
  return at + kinds.size() <= tokens.size() &&
         std::equal(kinds.begin(), kinds.end(), tokens.begin() + static_cast<std::ptrdiff_t>(at),
                    [](TokenKind kind, const Token& token) { return kind == token.kind; });
}

// `PRIORITY 5 BEHAVIOR greet`
void mend_order(Tokens& tokens, std::size_t at, const SourceFile& source,
                Diagnostics& diagnostics) {
  if (!are(tokens, at, {Kinds::PRIORITY, Kinds::QUANTITY, Kinds::BEHAVIOR, Kinds::NAME})) return;
  Span all = tokens[at].span;
  all.end = tokens[at + 3].span.end;
  const std::string better = "BEHAVIOR " + std::string(source.text(tokens[at + 3].span)) +
                             " PRIORITY " + std::string(source.text(tokens[at + 1].span));
  diagnostics.report(Code::E0001, "the PRIORITY comes after the name of a BEHAVIOR")
      .label(all)
      .helps("write `" + better + "`")
      .fix(all, better, Applicability::likely);
  const auto first = tokens.begin() + static_cast<std::ptrdiff_t>(at);
  std::rotate(first, first + 2, first + 4);
}

// `AT 10s DO`
void mend_time(Tokens& tokens, std::size_t at, const SourceFile& source, Diagnostics& diagnostics) {
  std::size_t next = at + 2;
  while (next < tokens.size() && tokens[next].kind == Kinds::NEWLINE)
    ++next;
  if (!are(tokens, at, {Kinds::AT, Kinds::QUANTITY}) || !are(tokens, next, {Kinds::DO})) return;
  const std::string time(source.text(tokens[at + 1].span));
  Span all = tokens[at].span;
  all.end = tokens[at + 1].span.end;
  diagnostics
      .report(Code::E0010, "a rule cannot begin with `" + std::string(source.text(all)) + "`")
      .label(all)
      .helps("to act once after the start, write `AT START DO`, then `WAIT " + time + "`")
      .helps("to act again and again, write `EVERY " + time + " DO`");
  tokens[at].kind = Kinds::EVERY;
}

// `GIVEN touch LEVEL = 5`
void mend_given(Tokens& tokens, std::size_t at, const SourceFile& source,
                Diagnostics& diagnostics) {
  const std::size_t sign =
      are(tokens, at, {Kinds::NAME, Kinds::NAME, Kinds::NAME}) ? at + 3 : at + 2;
  const Span word = tokens[at].span;
  if (!are(tokens, at, {Kinds::NAME, Kinds::NAME}) ||
      !are(tokens, sign, {Kinds::EQUAL, Kinds::QUANTITY}) ||
      !ascii::same(source.text(word), "GIVEN"))
    return;
  const Span step{word.file, tokens[at + 1].span.begin, tokens[sign + 1].span.end};
  diagnostics.report(Code::E0001, "a step of a TEST that sets a sensor begins with its time")
      .label(word)
      .helps("write `AT 0s " + std::string(source.text(step)) + "`")
      .fix(word, "AT 0s", Applicability::likely);
  tokens[at].kind = Kinds::AT;
  tokens.insert(tokens.begin() + static_cast<std::ptrdiff_t>(at) + 1,
                {Kinds::QUANTITY, {word.file, word.end, word.end}});
}

// `my-count`: one name in the whole file, if a line declares it.
void mend_torn_name(Tokens& tokens, std::size_t at, const SourceFile& source,
                    Diagnostics& diagnostics) {
  const auto is_torn = [&](std::size_t name) {
    return are(tokens, name, {Kinds::NAME, Kinds::MINUS, Kinds::NAME}) &&
           tokens[name].span.end == tokens[name + 1].span.begin &&
           tokens[name + 1].span.end == tokens[name + 2].span.begin;
  };
  const auto whole = [&](std::size_t name) {
    Span all = tokens[name].span;
    all.end = tokens[name + 2].span.end;
    return all;
  };
  if (at + 4 >= tokens.size() || !is_torn(at + 1) ||
      !declares(tokens[at].kind, tokens[at + 4].kind))
    return;
  const std::string word(source.text(whole(at + 1)));
  std::string better = word;
  std::ranges::replace(better, '-', '_');
  Diagnostic& message = diagnostics.report(Code::E0001, "a name has only letters, digits and `_`");
  message.label(whole(at + 1)).helps("write `" + better + "`");
  constexpr std::size_t most = 4;  // places shown
  std::size_t places = 0;
  for (std::size_t use = 0; use < tokens.size(); ++use) {
    if (!is_torn(use) || source.text(whole(use)) != word) continue;
    message.fix(whole(use), better, Applicability::likely);
    if (use != at + 1 && ++places < most) message.label(whole(use), "and here", false);
    tokens[use].span = whole(use);
    tokens.erase(tokens.begin() + static_cast<std::ptrdiff_t>(use) + 1,
                 tokens.begin() + static_cast<std::ptrdiff_t>(use) + 3);
  }
}

}  // namespace

void mend_heads(Tokens& tokens, const SourceFile& source, Diagnostics& diagnostics) {
  for (std::size_t at = 0; at + 1 < tokens.size(); ++at) {
    if (!starts_line(tokens, at)) continue;
    mend_order(tokens, at, source, diagnostics);
    mend_time(tokens, at, source, diagnostics);
    mend_given(tokens, at, source, diagnostics);
    mend_torn_name(tokens, at, source, diagnostics);
    if (tokens[at].kind != Kinds::BEHAVIOR) continue;
    const auto begin = tokens.begin() + static_cast<std::ptrdiff_t>(at) + 1;
    const auto end =
        std::find_if(begin, tokens.end(), [](const Token& token) { return ends_head(token.kind); });
    const auto first =
        std::find_if(begin, end, [](const Token& token) { return is_misplaced(token.kind); });
    if (first == end) continue;
    report(*first, tokens[at + 1], source, diagnostics);
    if (!rule_follows(tokens, static_cast<std::size_t>(end - tokens.begin()))) {
      tokens.erase(begin - 1, end);
      continue;
    }
    const bool number_missing = std::prev(first)->kind == Kinds::PRIORITY;
    if (number_missing) first->kind = Kinds::QUANTITY;
    tokens.erase(std::remove_if(number_missing ? std::next(first) : first, end,
                                [](const Token& token) { return is_misplaced(token.kind); }),
                 end);
  }
}

namespace {

bool has_capital(std::string_view text) {
  return std::ranges::any_of(text, [](char c) { return c >= 'A' && c <= 'Z'; });
}

// A word that cannot be a name, in lower case: RSL is mostly written in capitals. The name of a DEFINE begins a line, so it can
// be no word of RSL at all, however it is written.
bool is_reserved_name(const Token& token, bool define, const SourceFile& source) {
  if (!is_keyword(token.kind) || (!define && (roles_of(token.kind) & role::name) != 0))
    return false;
  const bool ends = token.kind == Kinds::END || token.kind == Kinds::DO;
  return !has_capital(source.text(token.span)) || (define && !ends);
}

// `margin BELOW 5` in a CHECK: a word that may follow the first line of the CHECK cannot begin a band.
bool is_reserved_band(const Tokens& tokens, std::size_t at, const SourceFile& source) {
  const unsigned roles = roles_of(tokens[at].kind);
  return starts_line(tokens, at) && is_keyword(tokens[at].kind) &&
         ((roles & role::name) == 0 || (roles & role::after) != 0) &&
         is_one_of(tokens[at + 1].kind, {Kinds::BELOW, Kinds::ABOVE}) &&
         tokens[at + 2].kind == Kinds::QUANTITY && !has_capital(source.text(tokens[at].span));
}

void report_reserved(const Token& name, const SourceFile& source, Diagnostics& diagnostics) {
  diagnostics
      .report(Code::E0010,
              "`" + std::string(source.text(name.span)) + "` is a word of RSL and cannot be a name")
      .label(name.span, "choose another name");
}

// From here on the word is a name in all such lines and where something is compared with it. So this runs at most once per word.
void make_band(Tokens& tokens, std::size_t at, const SourceFile& source) {
  const TokenKind kind = tokens[at].kind;
  for (std::size_t use = at; use + 2 < tokens.size(); ++use)
    if (tokens[use].kind == kind &&
        (is_reserved_band(tokens, use, source) ||
         is_one_of(tokens[use - 1].kind, {Kinds::IS, Kinds::NOT, Kinds::BECOMES})))
      tokens[use].kind = Kinds::NAME;
}

// Where a DEFINE gets its name or is run: `stop` on its own, but not `STOP arms`.
bool is_line_of_name(const Tokens& tokens, std::size_t at) {
  return at > 0 && at + 1 < tokens.size() &&
         is_one_of(tokens[at - 1].kind, {Kinds::DEFINE, Kinds::NEWLINE, Kinds::DO, Kinds::ELSE}) &&
         is_one_of(tokens[at + 1].kind, {Kinds::NEWLINE, Kinds::WITH, Kinds::END});
}

// A block with nothing in it would be a second mistake at the same place.
void fill_empty_block(Tokens& tokens, std::size_t line_end) {
  if (tokens[line_end].kind != Kinds::NEWLINE) return;
  std::size_t next = line_end;
  while (next < tokens.size() && tokens[next].kind == Kinds::NEWLINE)
    ++next;
  if (next == tokens.size() || tokens[next].kind != Kinds::END) return;
  Span gap = tokens[next].span;
  gap.end = gap.begin;
  tokens.insert(tokens.begin() + static_cast<std::ptrdiff_t>(next),
                {{Kinds::LOG, gap}, {Kinds::STRING, gap}, {Kinds::NEWLINE, gap}});
}

}  // namespace

void mend_robot_names(Tokens& tokens, const SourceFile& source, const Vocabulary& robot) {
  for (const std::string_view name : robot.reserved_names())
    for (std::size_t at = 1; at < tokens.size() && !has_capital(name); ++at)
      if (is_keyword(tokens[at].kind) && !starts_line(tokens, at) &&
          source.text(tokens[at].span) == name)
        tokens[at].kind = Kinds::NAME;
}

void mend_names(Tokens& tokens, const SourceFile& source, Diagnostics& diagnostics) {
  for (std::size_t at = 0; at + 2 < tokens.size(); ++at) {
    if (is_reserved_band(tokens, at, source)) {
      report_reserved(tokens[at], source, diagnostics);
      make_band(tokens, at, source);
      continue;
    }
    const bool declared = starts_line(tokens, at) && declares(tokens[at].kind, tokens[at + 2].kind);
    const bool define = tokens[at].kind == Kinds::DEFINE;
    if (!declared || !is_reserved_name(tokens[at + 1], define, source)) continue;
    const Token name = tokens[at + 1];
    const std::string_view word = source.text(name.span);
    report_reserved(name, source, diagnostics);
    // It is a name from here on, so no line can declare it again: this loop runs at most once per word of RSL.
    const bool everywhere = (roles_of(name.kind) & role::name) == 0 && !has_capital(word);
    for (std::size_t use = 0; use < tokens.size(); ++use)
      if (tokens[use].kind == name.kind && source.text(tokens[use].span) == word &&
          (everywhere || is_line_of_name(tokens, use)))
        tokens[use].kind = Kinds::NAME;
    if (define) fill_empty_block(tokens, at + 2);
  }
}

}  // namespace robosync::compiler
