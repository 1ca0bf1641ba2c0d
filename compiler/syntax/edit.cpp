// See edit.hpp.
#include "compiler/syntax/edit.hpp"

#include <algorithm>
#include <iterator>

#include "compiler/diagnostics/nearest.hpp"
#include "compiler/source/sorting.hpp"
#include "compiler/syntax/blocks.hpp"
#include "compiler/syntax/unit_apart.hpp"

namespace robosync::compiler {

namespace {

// How unlikely a kind of mistake is. Tuned by experiment: tests/compiler/syntax/mutation_test.cpp
// measures how many wrong programs give exactly one message.
namespace cost {
constexpr int respell_near = 8;  // plus 2 per wrong letter
constexpr int respell_far = 16;  // the first word of an earlier line
constexpr int join_unit = 10;    // 40 cm
constexpr int remove_repeated = 12;
constexpr int remove_end = 18;
constexpr int insert_frequent = 20;  // DO, END and the like
constexpr int insert_sign = 21;
constexpr int insert_value = 23;
constexpr int insert_operator = 30;
constexpr int insert_bracket = 32;
constexpr int insert_rare = 28;  // other words
constexpr int close_block = 20;  // plus 6 for each further one
constexpr int remove = 24;
constexpr int join_lines = 44;
constexpr int swap = 25;
constexpr int replace = 30;
constexpr int replace_end = 34;
constexpr int then_for_do = 18;  // IF x THEN, as in other languages
constexpr int skip_rest = 45;
constexpr int skip_line = 50;
constexpr int farther = 2;  // for each token before the one where the grammar stopped
}  // namespace cost

bool is_value(TokenKind kind) {
  return kind == Kinds::NAME || kind == Kinds::QUANTITY || kind == Kinds::STRING;
}

// Of tokens that the grammar treats alike, trying one is enough.
bool stands_for_others(TokenKind kind) {
  switch (kind) {
    case Kinds::GREATER:
    case Kinds::LESS_EQUAL:
    case Kinds::GREATER_EQUAL:
    case Kinds::NOT_EQUAL:
    case Kinds::MINUS:
    case Kinds::STAR:
    case Kinds::SLASH:
    case Kinds::MOD:
    case Kinds::OR:
    case Kinds::END_OF_FILE:
      return true;
    default:
      return false;
  }
}

bool is_frequent(TokenKind kind) {
  switch (kind) {
    case Kinds::WHEN:
    case Kinds::DO:
    case Kinds::END:
    case Kinds::DEFINE:
    case Kinds::BEHAVIOR:
    case Kinds::TO:
    case Kinds::IF:
    case Kinds::IS:
    case Kinds::OF:
    case Kinds::FROM:
    case Kinds::START:
    case Kinds::TIMES:
    case Kinds::ONE:
    case Kinds::OPTION:
      return true;
    default:
      return false;
  }
}

int insertion_cost(TokenKind kind, const std::vector<TokenKind>& expected) {
  if (is_value(kind)) return cost::insert_value;
  if (kind == Kinds::PLUS) return cost::insert_operator;
  if (kind == Kinds::OPEN) return cost::insert_bracket;
  if (!is_keyword(kind)) return cost::insert_sign;
  // A BEHAVIOR needs its PRIORITY; a rule hardly ever has one.
  if (kind == Kinds::PRIORITY && !contains(expected, Kinds::DO)) return cost::insert_frequent;
  return is_frequent(kind) ? cost::insert_frequent : cost::insert_rare;
}

bool goes_on_a_line(TokenKind kind) {
  return (roles_of(kind) & role::after) != 0;
}

using Expected = std::shared_ptr<const std::vector<TokenKind>>;

class Search {
public:
  Search(Tokens& tokens, const Attempt& failure, Reader& reader)
      : tokens_(tokens), failure_(failure), reader_(reader), source_(reader.source()) {}

  std::vector<Edit> all() {
    at_the_stop();
    before_the_stop();
    removals_and_swaps();
    close_blocks();
    respell();
    skips();
    sort_stably(edits_, {}, &Edit::cost);
    return std::move(edits_);
  }

private:
  struct Draft {
    Edit::What what;
    std::size_t at, removed;
    Tokens inserted;
    int cost;
  };

  void add(Draft draft, const Keyword* keyword = nullptr, Expected expected = nullptr) {
    edits_.push_back({draft.what, draft.at, draft.removed, std::move(draft.inserted), draft.cost,
                      keyword, std::move(expected)});
  }

  // A token that the text lacks has no width.
  Token missing(TokenKind kind, std::size_t at) const {
    const bool at_end = at >= tokens_.size();
    Span span = at_end ? tokens_.back().span : tokens_[at].span;
    span.end = span.begin;
    return {kind, span};
  }

  Token missing_after(TokenKind kind, std::size_t at) const {
    Span span = tokens_[at].span;
    span.begin = span.end;
    return {kind, span};
  }

  // The tokens that the grammar accepts in place of the token `at`.
  Expected expected_at(std::size_t at) {
    const Token kept = tokens_[at];
    tokens_[at].kind = Kinds::YYUNDEF;
    Attempt attempt = reader_.read(tokens_, nullptr);
    tokens_[at] = kept;
    if (attempt.stopped_at != at) attempt.expected.clear();
    return std::make_shared<const std::vector<TokenKind>>(std::move(attempt.expected));
  }

  bool is_line_end(std::size_t at) const {
    return at < tokens_.size() && tokens_[at].kind == Kinds::NEWLINE;
  }

  void insert(std::size_t at, TokenKind kind, int price, const Expected& expected) {
    // A second line end next to an existing one has no effect.
    const bool ends_twice = is_line_end(at) || (at > 0 && is_line_end(at - 1));
    if (kind == Kinds::NEWLINE && ends_twice) return;
    add({Edit::What::insert, at, 0, {missing(kind, at)}, price}, nullptr, expected);
    // A line end that was dropped before `at` would count after the new token, so also try before that line end.
    const bool line_dropped = at == failure_.stopped_at && failure_.before + 1 < at;
    if (!line_dropped) return;
    const Token token = missing_after(kind, failure_.before);
    add({Edit::What::insert, failure_.before + 1, 0, {token}, price + 1}, nullptr, expected);
  }

  void replace(std::size_t at, TokenKind kind, int extra, const Expected& expected) {
    if (at >= tokens_.size() || kind == Kinds::END_OF_FILE || kind == tokens_[at].kind) return;
    const TokenKind old = tokens_[at].kind;
    int price = old == Kinds::END ? cost::replace_end : cost::replace;
    if (old == Kinds::THEN && kind == Kinds::DO) price = cost::then_for_do;
    const Token token{kind, tokens_[at].span};
    add({Edit::What::replace, at, 1, {token}, price + extra}, nullptr, expected);
  }

  void around(std::size_t at, const Expected& expected, int extra) {
    for (const TokenKind kind : *expected) {
      // A NOT inverts a condition: a missing one is never the best guess.
      if (stands_for_others(kind) || kind == Kinds::NOT) continue;
      insert(at, kind, insertion_cost(kind, *expected) + extra, expected);
      replace(at, kind, extra, expected);
    }
  }

  // Replaces the first word of a line by one that continues the line before.
  void replace_first_word(std::size_t at, const Expected& expected) {
    for (const TokenKind kind : *expected) {
      if (goes_on_a_line(kind) && !stands_for_others(kind)) replace(at, kind, 0, expected);
    }
  }

  void at_the_stop() {
    const std::size_t at = failure_.stopped_at;
    around(at, expected_, 0);
    if (is_line_end(at)) replace_first_word(at + 1, expected_);
    // A line end before `at` was dropped because of `at`: also try as if it had counted.
    const bool line_dropped = at < tokens_.size() && starts_line(tokens_, at) &&
                              !is_line_end(failure_.before) && failure_.before < at;
    if (line_dropped) around(at, expected_at(at), 0);
  }

  void before_the_stop() {
    const std::size_t at = failure_.before;
    if (at >= failure_.stopped_at) return;
    expected_before_ = expected_at(at);
    around(at, expected_before_, cost::farther);
    if (is_line_end(at)) replace_first_word(failure_.stopped_at, expected_before_);
  }

  // Words up to the place where the grammar stopped, last first; if that place is the end of a line, with
  // the next word.
  std::vector<std::size_t> last_words(std::size_t count) const {
    std::vector<std::size_t> places;
    const std::size_t next = failure_.stopped_at + (is_line_end(failure_.stopped_at) ? 2 : 1);
    for (std::size_t at = std::min(next, tokens_.size()); at > 0 && places.size() < count;) {
      --at;
      if (!is_line_end(at)) places.push_back(at);
    }
    return places;
  }

  bool repeats_neighbour(std::size_t at) const {
    const auto same = [this, at](std::size_t other) {
      return tokens_[other].kind == tokens_[at].kind &&
             source_.text(tokens_[other].span) == source_.text(tokens_[at].span);
    };
    return (at > 0 && same(at - 1)) || (at + 1 < tokens_.size() && same(at + 1));
  }

  int removal_cost(std::size_t at) const {
    if (repeats_neighbour(at)) return cost::remove_repeated;
    if (is_behind_digits(tokens_, source_, at)) return cost::join_unit;
    return tokens_[at].kind == Kinds::END ? cost::remove_end : cost::remove;
  }

  // Swaps with the next word; line ends stay in place.
  void swap(std::size_t at, int extra) {
    std::size_t next = at + 1;
    while (is_line_end(next))
      ++next;
    if (next >= tokens_.size()) return;
    Tokens swapped(tokens_.begin() + static_cast<std::ptrdiff_t>(at),
                   tokens_.begin() + static_cast<std::ptrdiff_t>(next) + 1);
    std::swap(swapped.front(), swapped.back());
    add({Edit::What::swap, at, swapped.size(), std::move(swapped), cost::swap + extra});
  }

  void removals_and_swaps() {
    constexpr std::size_t reach_back = 4;
    int extra = 0;
    for (const std::size_t at : last_words(reach_back)) {
      Expected expected = at == failure_.stopped_at ? expected_ : nullptr;
      if (at == failure_.before) expected = expected_before_;
      add({Edit::What::remove, at, 1, {}, removal_cost(at) + extra}, nullptr, expected);
      swap(at, extra);
      extra += cost::farther;
    }
    const std::size_t stop = failure_.stopped_at;
    if (is_line_end(stop))
      add({Edit::What::remove, stop, 1, {}, cost::join_lines}, nullptr, expected_);
  }

  // Inserts one or more END before the line that does not fit into the open blocks.
  void close_blocks() {
    constexpr int most = 4;
    const bool line_end = is_line_end(failure_.before);
    const std::size_t place = line_end ? failure_.before : failure_.stopped_at;
    Tokens ends;
    for (int count = 1; count <= most; ++count) {
      if (count > 1) ends.push_back(missing(Kinds::NEWLINE, place));
      ends.push_back(missing(Kinds::END, place));
      if (!line_end) ends.push_back(missing(Kinds::NEWLINE, place));
      add({Edit::What::close_blocks, place, 0, ends, cost::close_block + 6 * (count - 1)});
      if (!line_end) ends.pop_back();
    }
  }

  void respell_at(std::size_t at, int price) {
    const std::string_view word = source_.text(tokens_[at].span);
    if (tokens_[at].kind != Kinds::NAME || word.empty()) return;
    for (const Keyword& keyword : keywords()) {
      if (!is_near(word, keyword.spelling)) continue;
      const int wrong = static_cast<int>(mistakes(word, keyword.spelling));
      const Token other{keyword.kind, tokens_[at].span};
      add({Edit::What::respell, at, 1, {other}, price + 2 * wrong}, &keyword);
    }
  }

  // Tries names near the place, and the first words of earlier lines: a misspelt IF or END
  // reads as a verb, so the grammar stops much later.
  void respell() {
    constexpr std::size_t near = 4;
    constexpr std::size_t lines_back = 40;
    const std::vector<std::size_t> places = last_words(near);
    for (const std::size_t at : places)
      respell_at(at, cost::respell_near);
    std::size_t lines = 0;
    for (std::size_t at = places.empty() ? 0 : places.back(); at > 0 && lines < lines_back;) {
      --at;
      if (!starts_line(tokens_, at)) continue;
      ++lines;
      respell_at(at, cost::respell_far);
    }
  }

  std::size_t line_end(std::size_t at) const {
    while (at < tokens_.size() && tokens_[at].kind != Kinds::NEWLINE)
      ++at;
    return at;
  }

  // Gives up on the rest of the line, or on all of it.
  void skips() {
    const std::size_t at = std::min(failure_.stopped_at, tokens_.size() - 1);
    const std::size_t end = line_end(at);
    std::size_t begin = at;
    while (begin > 0 && tokens_[begin - 1].kind != Kinds::NEWLINE)
      --begin;
    if (end > at) add({Edit::What::skip, at, end - at, {}, cost::skip_rest});
    if (end > begin) add({Edit::What::skip, begin, end - begin, {}, cost::skip_line});
    if (end > begin) {  // an empty statement instead of the line
      add({Edit::What::skip,
           begin,
           end - begin,
           {missing(Kinds::NAME, begin)},
           cost::skip_line + 2});
    }
  }

  Tokens& tokens_;
  const Attempt& failure_;
  Reader& reader_;
  const SourceFile& source_;
  Expected expected_ = std::make_shared<const std::vector<TokenKind>>(failure_.expected);
  Expected expected_before_;  // in place of the token before
  std::vector<Edit> edits_;
};

}  // namespace

std::vector<Edit> possible_edits(Tokens& tokens, const Attempt& failure, Reader& reader) {
  return Search(tokens, failure, reader).all();
}

Tokens edited(const Tokens& tokens, const Edit& edit) {
  Tokens changed;
  changed.reserve(tokens.size() - edit.removed + edit.inserted.size());
  const auto from = tokens.begin() + static_cast<std::ptrdiff_t>(edit.at);
  const auto to = from + static_cast<std::ptrdiff_t>(edit.removed);
  std::copy(tokens.begin(), from, std::back_inserter(changed));
  std::copy(edit.inserted.begin(), edit.inserted.end(), std::back_inserter(changed));
  std::copy(to, tokens.end(), std::back_inserter(changed));
  return changed;
}

}  // namespace robosync::compiler
