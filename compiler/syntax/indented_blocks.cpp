// See indented_blocks.hpp.
#include "compiler/syntax/indented_blocks.hpp"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "compiler/syntax/blocks.hpp"
#include "compiler/syntax/keyword_roles.hpp"
#include "compiler/syntax/word_list.hpp"

namespace robosync::compiler {
namespace {

constexpr std::size_t kMost = 400;  // tokens inserted: looking for their ends takes time

class IndentedBlocks {
public:
  IndentedBlocks(Tokens& tokens, const SourceFile& source, Diagnostics& diagnostics)
      : tokens_(tokens), source_(source), diagnostics_(diagnostics), walk_(tokens) {}

  // Quick where there are none.
  [[nodiscard]] bool any() const {
    for (std::size_t at = 0; at < tokens_.size(); ++at) {
      const bool last = is(at + 1, Kinds::NEWLINE) || at + 1 == tokens_.size();
      if (last && (is(at, Kinds::COLON) || is_left_out(at))) return true;
      if (starts_line(tokens_, at) && (is(at, Kinds::IF) || (last && is_endless(at))) &&
          margin(at) == 0)
        return true;
    }
    return false;
  }

  void mend() {
    for (std::size_t at = 0; at < tokens_.size() && places_.size() < kMost; ++at) {
      if (starts_line(tokens_, at)) mend_line(at);
      walk_.step(at);
    }
    insert();
  }

private:
  [[nodiscard]] bool is(std::size_t at, TokenKind kind) const {
    return at < tokens_.size() && tokens_[at].kind == kind;
  }
  [[nodiscard]] bool is_name(std::size_t at, std::string_view words) const {
    return is(at, Kinds::NAME) && has_word(words, source_.text(tokens_[at].span));
  }
  // `forever`, alone in its line
  [[nodiscard]] bool is_endless(std::size_t at) const {
    return is(at, Kinds::FOREVER) || is_name(at, "LOOP ALWAYS");
  }
  // The end of `for i in range(3):`, which the lexer has reported.
  [[nodiscard]] bool is_left_out(std::size_t at) const {
    return is(at, Kinds::TIMES) && tokens_[at].span.begin == tokens_[at].span.end;
  }
  [[nodiscard]] bool is_outside(std::size_t at) const {
    const auto closed = std::ranges::count_if(closed_, [at](auto end) { return end <= at; });
    return walk_.open().size() <= static_cast<std::size_t>(closed);
  }

  // ---- lines

  [[nodiscard]] std::size_t line_end(std::size_t at) const {
    while (at < tokens_.size() && !is(at, Kinds::NEWLINE))
      ++at;
    return at;
  }
  [[nodiscard]] std::size_t next_line(std::size_t at) const {
    while (is(at, Kinds::NEWLINE))
      ++at;
    return at;
  }
  // The end of the first line of a block; a word such as AND continues it on the next line.
  [[nodiscard]] std::size_t head_end(std::size_t at) const {
    for (std::size_t end = line_end(at);;) {
      const std::size_t next = next_line(end);
      const TokenKind last = tokens_[end - 1].kind;
      const bool waits =
          last != Kinds::COLON && (roles_of(last) & (role::before | role::begins)) == role::before;
      const bool goes_on = waits || is(next, Kinds::AND) || is(next, Kinds::OR);
      if (!goes_on || next == tokens_.size()) return end;
      end = line_end(next);
    }
  }
  [[nodiscard]] std::size_t margin(std::size_t at) const {
    return indentation(tokens_[at], source_);
  }
  [[nodiscard]] bool continues(std::size_t at) const {
    return is(at, Kinds::ELSE) || is(at, Kinds::ELSE_IF) || is_name(at, "ELIF");
  }
  // The first word after the block that begins at `at`, by its indentation.
  [[nodiscard]] std::size_t block_end(std::size_t at) const {
    const std::size_t column = margin(at);
    std::size_t next = next_line(head_end(at));
    while (next < tokens_.size() &&
           (margin(next) > column || (margin(next) == column && continues(next))))
      next = next_line(line_end(next));
    return next;
  }
  [[nodiscard]] bool ends_block(std::size_t end, std::size_t at) const {
    return is(end, Kinds::END) && margin(end) == margin(at);
  }

  // ---- mistakes

  void mend_line(std::size_t at) {
    const bool rule = is(at, Kinds::IF) && is_outside(at);
    const bool endless = is(at + 1, Kinds::NEWLINE) && is_endless(at);
    if (!opens(at) && !endless) return;
    const std::size_t end = head_end(at), after = block_end(at);
    if (rule && !has_do(at, end)) return mend_rule(at, end, after);
    const bool colon = is(end - 1, Kinds::COLON);
    if (!endless && !colon && !is_left_out(end - 1)) return;
    if (after == next_line(end) || ends_block(after, at)) return;
    if (colon && !is(at + 1, Kinds::TRUE)) report(at, end, false);
    mend_colons(at, after);
    insert_before(after, {Kinds::END, Kinds::NEWLINE});
    if (!endless) closed_.push_back(after);
  }

  [[nodiscard]] bool opens(std::size_t at) const {
    if (is(at, Kinds::AT)) return is(at + 1, Kinds::START);
    return (roles_of(tokens_[at].kind) & role::opens) != 0;
  }
  [[nodiscard]] bool has_do(std::size_t at, std::size_t end) const {
    for (; at < end; ++at)
      if (is(at, Kinds::DO)) return true;
    return is(next_line(end), Kinds::DO);
  }

  // `IF touch LEVEL > 3 THEN SHOW face happy`, outside of all rules: read as if a WHEN were around it
  void mend_rule(std::size_t at, std::size_t end, std::size_t after) {
    std::size_t then = at;
    while (then < end && !is(then, Kinds::THEN) && !(is(then, Kinds::COLON) && then + 1 == end))
      ++then;
    if (then == at + 1) return;
    report(at, then, true);
    insert_before(at, {Kinds::WHEN, Kinds::QUANTITY, Kinds::LESS, Kinds::QUANTITY, Kinds::DO});
    if (then == end)
      insert_before(end, {Kinds::DO});
    else
      tokens_[then].kind = Kinds::DO;
    mend_colons(at, after);
    const std::size_t closing = ends_block(after, at) ? after : own_end(at, after);
    if (closing < tokens_.size() && is(closing, Kinds::END)) {
      after = line_end(closing);
      for (std::size_t word = closing + 1; word < after; ++word)  // `END IF`
        tokens_[word].kind = Kinds::NEWLINE;
    } else {
      insert_before(after, {Kinds::END, Kinds::NEWLINE});
      closed_.push_back(after);
    }
    insert_before(after, {Kinds::END, Kinds::NEWLINE});
  }

  // The END of the block if its lines are not indented; otherwise `after`.
  [[nodiscard]] std::size_t own_end(std::size_t at, std::size_t after) const {
    if (after != next_line(head_end(at))) return after;
    BlockWalk rest = walk_;
    const std::size_t before = rest.open().size();
    for (; at < tokens_.size(); ++at) {
      rest.step(at);
      if (is(at, Kinds::END) && rest.open().size() == before) return at;
      if (starts_line(tokens_, at) && (roles_of(tokens_[at].kind) & role::item) != 0) break;
    }
    return after;
  }

  // The colons of the block's own lines, not those of blocks in it.
  void mend_colons(std::size_t at, std::size_t after) {
    const std::size_t column = margin(at);
    for (; at < after; at = next_line(head_end(at))) {
      if (margin(at) != column) continue;
      if (is_name(at, "ELIF")) tokens_[at].kind = Kinds::ELSE_IF;
      const std::size_t colon = head_end(at) - 1;
      if (!is(colon, Kinds::COLON)) continue;
      const bool repeats =
          is(at, Kinds::REPEAT) && is(colon - 1, Kinds::QUANTITY) && colon == at + 2;
      // A second line end means nothing.
      tokens_[colon].kind = asks(at) ? Kinds::DO : repeats ? Kinds::TIMES : Kinds::NEWLINE;
    }
  }
  [[nodiscard]] bool asks(std::size_t at) const {
    return is_one_of(tokens_[at].kind, {Kinds::WHEN, Kinds::WHILE, Kinds::EVERY, Kinds::AT,
                                        Kinds::IF, Kinds::ELSE_IF});
  }

  // Once: whoever writes one block like this writes all of them so.
  void report(std::size_t at, std::size_t end, bool rule) {
    if (std::exchange(said_, true)) return;
    Span word = tokens_[at].span, words = word, rest = word;
    rest.begin = word.end;
    words.end = rest.end = tokens_[end - 1].span.end;
    std::string line(rule ? "WHEN" : source_.text(word));
    line += source_.text(rest);
    if (line.back() == ':') line.pop_back();
    if (asks(at)) line += " DO";
    if (is(at, Kinds::REPEAT)) line += " TIMES";
    diagnostics_
        .report(rule ? Code::E0010 : Code::E0001,
                rule ? "`IF` checks once, inside a rule; a rule begins with `WHEN`"
                     : "a block ends with `END`, not where it is no longer indented")
        .label(rule ? word : words)
        .helps("write `" + line + "`, the commands, and `END`");
  }

  // ---- tokens that the text lacks

  void insert_before(std::size_t at, std::initializer_list<TokenKind> kinds) {
    Span place = tokens_[std::min(at, tokens_.size() - 1)].span;
    place.end = place.begin;
    for (const TokenKind kind : kinds) {
      places_.push_back(at);
      inserted_.push_back({kind, place});
    }
  }

  // Those for the same place, in their order.
  void insert() {
    for (std::size_t one = 0; one < places_.size(); ++one) {
      const auto before =
          std::count_if(places_.begin(), places_.begin() + static_cast<std::ptrdiff_t>(one),
                        [&](std::size_t place) { return place <= places_[one]; });
      tokens_.insert(tokens_.begin() + before + static_cast<std::ptrdiff_t>(places_[one]),
                     inserted_[one]);
    }
  }

  Tokens& tokens_;
  const SourceFile& source_;
  Diagnostics& diagnostics_;
  BlockWalk walk_;
  Tokens inserted_;
  std::vector<std::size_t> places_;  // each before the token with this index
  std::vector<std::size_t> closed_;  // where a block has got the END that the walk does not know
  bool said_ = false;
};

}  // namespace

void mend_indented_blocks(Tokens& tokens, const SourceFile& source, Diagnostics& diagnostics) {
  IndentedBlocks blocks(tokens, source, diagnostics);
  if (blocks.any()) blocks.mend();
}

}  // namespace robosync::compiler
