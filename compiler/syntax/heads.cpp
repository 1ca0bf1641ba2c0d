// See heads.hpp.
#include "compiler/syntax/heads.hpp"

#include <algorithm>
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

void mend_heads(Tokens& tokens, const SourceFile& source, Diagnostics& diagnostics) {
  for (std::size_t at = 0; at + 1 < tokens.size(); ++at) {
    if (tokens[at].kind != Kinds::BEHAVIOR || !starts_line(tokens, at)) continue;
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
