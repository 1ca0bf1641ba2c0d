// See layout.hpp.
#include "compiler/syntax/layout.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "compiler/syntax/blocks.hpp"
#include "compiler/syntax/keyword_roles.hpp"

namespace robosync::compiler {

// ---- line ends

void significant(std::vector<Token>& tokens, std::vector<std::uint32_t>& order) {
  if (!tokens.empty() && tokens.back().kind != Kinds::NEWLINE) {
    const Span last = tokens.back().span;
    tokens.push_back({Kinds::NEWLINE, {last.file, last.end, last.end}});
  }
  order.clear();
  order.reserve(tokens.size());
  bool pending = false;  // a line end that may count
  std::uint32_t line_end = 0;
  for (std::uint32_t i = 0; i < tokens.size(); ++i) {
    const TokenKind kind = tokens[i].kind;
    if (kind == Kinds::NEWLINE) {
      if (!pending) line_end = i;
      pending = true;
      continue;
    }
    // A row of a MOTION may end with "-". The next row begins with AT, which never continues an expression.
    const bool new_row =
        kind == Kinds::AT && !order.empty() && tokens[order.back()].kind == Kinds::MINUS;
    const bool goes_on =
        !new_row && (order.empty() || (roles_of(tokens[order.back()].kind) & role::before) != 0);
    if (pending && !goes_on && (roles_of(kind) & role::after) == 0) order.push_back(line_end);
    pending = false;
    order.push_back(i);
  }
  if (!order.empty()) order.push_back(line_end);
}

// ---- regions

namespace {

class Splitter {
public:
  Splitter(std::span<const Token> tokens, const SourceFile& source)
      : tokens_(tokens), source_(source), walk_(tokens) {}

  std::vector<Region> split() {
    for (std::size_t at = 0; at < tokens_.size(); ++at) {
      const bool first = tokens_[at].kind != Kinds::NEWLINE && starts_line(tokens_, at);
      const unsigned roles = first ? line_roles(at) : 0U;
      if (first && starts_item(at, roles)) start_region(at);
      walk_.step(at);
      if (tokens_[at].kind == Kinds::NAME && (roles & role::opens) != 0) walk_.count_as_opener(at);
      if (walk_.end_was_idle() || closes_too_early(at)) damaged_ = true;
    }
    start_region(tokens_.size());
    return std::move(regions_);
  }

private:
  // Outside all blocks, a word that is not a keyword must be a misspelt keyword.
  unsigned line_roles(std::size_t at) {
    const Token& token = tokens_[at];
    if (token.kind == Kinds::AT) {
      const bool rule = at + 1 < tokens_.size() && tokens_[at + 1].kind == Kinds::START;
      return rule ? roles_of(token.kind) : 0U;
    }
    if (token.kind != Kinds::NAME || !walk_.open().empty()) return roles_of(token.kind);
    const Keyword* meant = nearest_keyword(source_.text(token.span), role::item | role::part);
    return meant != nullptr ? meant->roles : 0U;
  }

  // An END that is indented deeper than the item's first word closes something inside the item.
  bool closes_too_early(std::size_t at) const {
    const bool item = tokens_[at].kind == Kinds::END && walk_.open().empty();
    return item && starts_line(tokens_, at) && indentation(tokens_[at], source_) > indentation_;
  }

  bool starts_item(std::size_t at, unsigned roles) {
    const bool outside = walk_.open().empty();
    if ((roles & role::item) != 0) {
      const bool indented = indentation(tokens_[at], source_) > indentation_;
      return outside || !(indented || is_in_behavior(at));
    }
    if (!outside) return false;
    if ((roles & role::part) != 0) return !damaged_;
    // Neither: the mistake is on this line, and the following lines may belong to it.
    damaged_ = true;
    return false;
  }

  // Without indentation, an item belongs to the open BEHAVIOR if an END further down closes that.
  bool is_in_behavior(std::size_t at) {
    const std::size_t opener = walk_.open().front();
    if (walk_.open().size() != 1 || tokens_[opener].kind != Kinds::BEHAVIOR) return false;
    if (checked_ == opener) return closed_;
    checked_ = opener;
    constexpr std::size_t farthest = 4000;  // tokens: a BEHAVIOR is shorter
    BlockWalk rest = walk_;
    for (; at < tokens_.size() && at < opener + farthest && !rest.open().empty(); ++at)
      rest.step(at);
    return closed_ = rest.open().empty();
  }

  void start_region(std::size_t at) {
    if (at > begin_) regions_.push_back({begin_, at});
    begin_ = at;
    walk_ = BlockWalk(tokens_);
    damaged_ = false;
    if (at < tokens_.size()) indentation_ = indentation(tokens_[at], source_);
  }

  std::span<const Token> tokens_;
  const SourceFile& source_;
  BlockWalk walk_;
  std::vector<Region> regions_;
  std::size_t begin_ = 0;
  std::size_t indentation_ = 0;
  bool damaged_ = false;
  std::size_t checked_ = SIZE_MAX;  // the BEHAVIOR that is_in_behavior() has followed to its end …
  bool closed_ = false;             // … and whether it found one
};

}  // namespace

std::vector<Region> split_into_regions(std::span<const Token> tokens, const SourceFile& source) {
  return Splitter(tokens, source).split();
}

// ---- depth

namespace {

bool is_sign(TokenKind kind) {
  return kind == Kinds::MINUS || kind == Kinds::NOT || kind == Kinds::OPEN;
}

// A quick test: most pieces have too few tokens that nest to be too deep.
bool may_be_deep(std::span<const Token> tokens) {
  const auto goes_down = [](const Token& token) {
    return is_sign(token.kind) || token.kind == Kinds::ELSE_IF ||
           (roles_of(token.kind) & role::opens) != 0;
  };
  return std::ranges::count_if(tokens, goes_down) > static_cast<std::ptrdiff_t>(kDeepestBlock);
}

// Counts what makes the grammar's stack grow: open IF, REPEAT and PICK blocks (each ELSE IF nests in
// the one before), open brackets, and signs in a row such as NOT NOT NOT.
class Depth {
public:
  explicit Depth(std::span<const Token> tokens) : tokens_(tokens), walk_(tokens) {}

  bool too_deep_at(std::size_t at) {
    step_blocks(at);
    step_expression(tokens_[at].kind);
    return in_too_many_blocks() || brackets_ > kDeepestBracket || signs_ > kDeepestBracket;
  }

  [[nodiscard]] bool in_too_many_blocks() const { return blocks_ > kDeepestBlock; }

private:
  bool is_statement(std::size_t at) const {
    return (roles_of(tokens_[at].kind) & role::statement) != 0;
  }

  void step_blocks(std::size_t at) {
    const std::size_t open_before = walk_.open().size();
    walk_.step(at);
    if (tokens_[at].kind == Kinds::ELSE_IF && !levels_.empty()) {
      ++levels_.back();
      ++blocks_;
    }
    if (walk_.open().size() > open_before) {
      levels_.push_back(is_statement(at) ? 1 : 0);
      blocks_ += levels_.back();
    }
    if (walk_.open().size() < open_before) {
      blocks_ -= levels_.back();
      levels_.pop_back();
    }
  }

  void step_expression(TokenKind kind) {
    const bool line_goes_on = (roles_of(last_) & role::before) != 0;
    if (kind == Kinds::NEWLINE && line_goes_on) return;
    last_ = kind;
    if (kind == Kinds::NEWLINE) brackets_ = 0;
    if (kind == Kinds::OPEN) ++brackets_;
    if (kind == Kinds::CLOSE && brackets_ > 0) --brackets_;
    signs_ = is_sign(kind) ? signs_ + 1 : 0;
  }

  std::span<const Token> tokens_;
  BlockWalk walk_;
  TokenKind last_ = Kinds::NEWLINE;
  std::vector<std::size_t> levels_;  // of each open block
  std::size_t blocks_ = 0, brackets_ = 0, signs_ = 0;
};

}  // namespace

std::optional<TooDeep> nested_too_deeply(std::span<const Token> tokens) {
  if (!may_be_deep(tokens)) return std::nullopt;
  Depth depth(tokens);
  for (std::size_t at = 0; at < tokens.size(); ++at) {
    if (depth.too_deep_at(at)) return TooDeep{at, depth.in_too_many_blocks()};
  }
  return std::nullopt;
}

}  // namespace robosync::compiler
