// The line in which the grammar stopped, for the code that recognises a mistake by its words (habits.cpp,
// foreign_habits.cpp): which words are where, and how the grammar can continue.
#pragma once

#include <algorithm>
#include <initializer_list>
#include <optional>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "compiler/diagnostics/diagnostic.hpp"
#include "compiler/source/ascii.hpp"
#include "compiler/source/source_file.hpp"
#include "compiler/syntax/blocks.hpp"
#include "compiler/syntax/edit.hpp"
#include "compiler/syntax/reader.hpp"

namespace robosync::compiler {

class MistakenLine {
public:
  MistakenLine(const Tokens& tokens, const SourceFile& source, const Attempt& failure,
               Diagnostics& diagnostics)
      : tokens_(tokens),
        source_(source),
        stop_(failure.stopped_at),
        before_(failure.before),
        expected_(failure.expected),
        diagnostics_(diagnostics) {
    if (stop_ >= tokens_.size()) return;
    // The grammar does not see the line end before an END, but that is where something is missing.
    if (is(stop_, Kinds::END) && before_ < stop_ && is(before_ + 1, Kinds::NEWLINE))
      stop_ = before_ + 1;
    for (begin_ = stop_; begin_ > 0 && !is(begin_ - 1, Kinds::NEWLINE);)
      --begin_;
    for (end_ = stop_; end_ < tokens_.size() && !is(end_, Kinds::NEWLINE);)
      ++end_;
    statement_ = stop_;
    while (statement_ > begin_ && !begins_statement(statement_ - 1))
      --statement_;
  }

protected:
  // ---- the words of the line

  bool is(std::size_t at, TokenKind kind) const {
    return at < tokens_.size() && tokens_[at].kind == kind;
  }

  std::string_view text(std::size_t at) const {
    return at < tokens_.size() ? source_.text(tokens_[at].span) : std::string_view();
  }

  // The source text from the token `from` to the one before `to`.
  std::string text(std::size_t from, std::size_t to) const {
    return from < to ? std::string(source_.text(span(from, to))) : std::string();
  }

  // The text after the name in the line that declares it with that keyword, such as STATE. Searches the whole file, because
  // the tokens are those of this item only.
  std::optional<std::string_view> behind_declaration(std::string_view keyword,
                                                     std::string_view name) const {
    for (std::uint32_t line = 1; line <= source_.lines(); ++line) {
      std::string_view rest = source_.line(line);
      const auto next = [&rest] {
        rest.remove_prefix(std::min(rest.find_first_not_of(" \t"), rest.size()));
        const std::string_view word = rest.substr(0, rest.find_first_of(" \t\r:("));
        rest.remove_prefix(word.size());
        return word;
      };
      if (ascii::same(next(), keyword) && ascii::same(next(), name)) return rest;
    }
    return std::nullopt;
  }

  std::string quote(std::size_t at) const { return "`" + std::string(text(at)) + "`"; }

  bool is_name(std::size_t at, std::string_view word) const {
    return is(at, Kinds::NAME) && ascii::same(text(at), word);
  }
  bool is_any_name(std::size_t at, std::initializer_list<std::string_view> words) const {
    return std::any_of(words.begin(), words.end(), [&](auto word) { return is_name(at, word); });
  }

  Span span(std::size_t from, std::size_t to) const {
    Span all = tokens_[from].span;
    if (to > from) all.end = tokens_[to - 1].span.end;
    return all;
  }

  // From `at` on, the first token that is no line end.
  std::size_t after_line_ends(std::size_t at) const {
    while (is(at, Kinds::NEWLINE))
      ++at;
    return at;
  }

  bool begins_statement(std::size_t at) const {
    return is_one_of(tokens_[at].kind, {Kinds::DO, Kinds::ELSE, Kinds::NEWLINE, Kinds::OPTION});
  }

  bool begins_with(TokenKind kind) const { return is(statement_, kind); }

  bool has(std::size_t from, std::size_t to, TokenKind kind) const {
    for (std::size_t at = from; at < to; ++at)
      if (is(at, kind)) return true;
    return false;
  }

  // The index after the last token of the statement.
  std::size_t statement_end() const { return statement_end_from(stop_); }
  std::size_t statement_end_from(std::size_t at) const {
    while (at < end_ && !is_one_of(tokens_[at].kind, {Kinds::DO, Kinds::ELSE, Kinds::ELSE_IF,
                                                      Kinds::END, Kinds::THEN, Kinds::OPTION}))
      ++at;
    return at;
  }

  // Does the statement ask something before `at`?
  bool asks_before(std::size_t at) const {
    while (at > 0 && !is_one_of(tokens_[at - 1].kind, {Kinds::DO, Kinds::ELSE})) {
      --at;
      if (begins_question(tokens_[at].kind)) return true;
      const bool goes_on = at > 0 && (roles_of(tokens_[at - 1].kind) & role::before) != 0;
      if (is(at, Kinds::NEWLINE) && !goes_on) return false;
    }
    return false;
  }

  // Only commas outside brackets count.
  bool has_comma(std::size_t from, std::size_t to) const {
    int open = 0;
    for (std::size_t at = from; at < to; ++at) {
      if (is(at, Kinds::OPEN)) ++open;
      if (is(at, Kinds::CLOSE)) --open;
      if (is(at, Kinds::COMMA) && open == 0) return true;
    }
    return false;
  }

  // `MIN(`, not `SLOWLY (`
  bool is_call(std::size_t open) const {
    return open > 0 && is(open, Kinds::OPEN) && is(open - 1, Kinds::NAME) &&
           tokens_[open - 1].span.end == tokens_[open].span.begin;
  }

  // True when every bracket in the range is closed in it.
  bool is_balanced(std::size_t from, std::size_t to) const {
    int open = 0;
    for (std::size_t at = from; at < to && open >= 0; ++at) {
      if (is(at, Kinds::OPEN)) ++open;
      if (is(at, Kinds::CLOSE)) --open;
    }
    return open == 0;
  }

  // The bracket that closes the one at `open`; the end of the line when it is not closed.
  std::size_t closing(std::size_t open) const {
    std::size_t depth = 0;
    for (std::size_t at = open; at < end_; ++at) {
      if (is(at, Kinds::OPEN)) ++depth;
      if (is(at, Kinds::CLOSE) && --depth == 0) return at;
    }
    return end_;
  }

  // The first word of the innermost open block where the grammar stopped.
  std::optional<std::size_t> open_block() const {
    BlockWalk walk(tokens_);
    for (std::size_t at = 0; at < stop_; ++at)
      walk.step(at);
    if (walk.open().empty()) return std::nullopt;
    return walk.open().back();
  }

  // ---- how the grammar can continue

  Tokens::const_iterator at(std::size_t place) const {
    return tokens_.begin() + static_cast<std::ptrdiff_t>(place);
  }

  static Edit change(std::size_t at, std::size_t removed, Tokens inserted = {}) {
    Edit edit;
    edit.what = Edit::What::replace;
    edit.at = at;
    edit.removed = removed;
    edit.inserted = std::move(inserted);
    return edit;
  }

  // A token that the text lacks has no width.
  Token missing(TokenKind kind, std::size_t at) const {
    Span place = at < tokens_.size() ? tokens_[at].span : tokens_.back().span;
    place.end = place.begin;
    return {kind, place};
  }

  Diagnostic& report(Code code, std::string message, Span place) {
    Diagnostic& diagnostic = diagnostics_.report(code, std::move(message));
    diagnostic.label(place);
    return diagnostic;
  }

  // Both texts have the words in the places of `{0}`, `{1}`, …
  template <typename... Words>
  Diagnostic& say(Code code, Span place, std::string_view text, std::string_view help,
                  const Words&... words) {
    return say_with(code, place, text, help, fmt::make_format_args(words...));
  }
  Diagnostic& say_with(Code code, Span place, std::string_view text, std::string_view help,
                       fmt::format_args words) {
    return report(code, fmt::vformat(text, words), place).helps(fmt::vformat(help, words));
  }

  const Tokens& tokens_;
  const SourceFile& source_;
  std::size_t stop_, before_;
  const std::vector<TokenKind>& expected_;  // the tokens that the grammar would accept
  std::size_t begin_ = 0, end_ = 0;         // of the line
  std::size_t statement_ = 0;               // its first token
  Diagnostics& diagnostics_;
};

}  // namespace robosync::compiler
