// See blocks.hpp.
#include "compiler/syntax/blocks.hpp"

#include <algorithm>

#include "compiler/syntax/keyword_roles.hpp"

namespace robosync::compiler {

bool starts_line(std::span<const Token> tokens, std::size_t at) {
  return at == 0 || tokens[at - 1].kind == Kinds::NEWLINE;
}

std::size_t indentation(const Token& token, const SourceFile& source) {
  const std::string_view text = source.text();
  std::size_t start = token.span.begin;
  while (start > 0 && text[start - 1] != '\n' && text[start - 1] != '\r')
    --start;
  return token.span.begin - start;
}

bool BlockWalk::opens(std::size_t at) {
  const TokenKind kind = tokens_[at].kind;
  if (kind == Kinds::WHEN && safety_) {
    safety_ = false;
    return false;
  }
  if (!statement_ || (roles_of(kind) & role::opens) == 0) return false;
  if (kind == Kinds::AT) return at + 1 < tokens_.size() && tokens_[at + 1].kind == Kinds::START;
  return true;
}

void BlockWalk::step(std::size_t at) {
  const TokenKind kind = tokens_[at].kind;
  idle_ = kind == Kinds::END && open_.empty();
  if (kind == Kinds::END && !open_.empty()) {
    closed_ = open_.back();
    open_.pop_back();
  }
  if (opens(at)) {
    open_.push_back(at);
    safety_ = kind == Kinds::SAFETY;
  }
  const bool weight = kind == Kinds::QUANTITY && at > 0 && tokens_[at - 1].kind == Kinds::OPTION;
  statement_ = kind == Kinds::NEWLINE || (roles_of(kind) & role::begins) != 0 || weight;
}

namespace {

// The indentation of the line that the token starts; nothing when it does not start a line.
std::optional<std::size_t> margin(const Tokens& tokens, std::size_t at, const SourceFile& source) {
  if (!starts_line(tokens, at)) return std::nullopt;
  return indentation(tokens[at], source);
}

// True when both start lines and `end` is indented less than the block it closes.
bool stands_left(const Tokens& tokens, std::size_t end, std::size_t opener,
                 const SourceFile& source) {
  const auto end_margin = margin(tokens, end, source);
  const auto opener_margin = margin(tokens, opener, source);
  return end_margin && opener_margin && *end_margin < *opener_margin;
}

}  // namespace

std::vector<OpenBlock> open_blocks(const Tokens& tokens, std::size_t at, std::size_t count,
                                   const SourceFile& source) {
  BlockWalk walk(tokens);
  std::vector<OpenBlock> blocks;
  const std::size_t last = std::min(at, tokens.size());
  for (std::size_t i = 0; i < last; ++i) {
    walk.step(i);
    const bool closes = tokens[i].kind == Kinds::END && !walk.end_was_idle();
    if (closes && blocks.size() < count && stands_left(tokens, i, walk.closed(), source)) {
      blocks.push_back({walk.closed(), i});
    }
  }
  const std::vector<std::size_t>& open = walk.open();
  for (std::size_t i = open.size(); i > 0 && blocks.size() < count; --i) {
    blocks.push_back({open[i - 1], at});
  }
  return blocks;
}

std::optional<IdleEnd> early_end(const Tokens& tokens, std::size_t at, const SourceFile& source) {
  BlockWalk walk(tokens);
  for (std::size_t i = 0; i < at && i < tokens.size(); ++i) {
    walk.step(i);
    if (tokens[i].kind != Kinds::END || walk.end_was_idle()) continue;
    const auto end_margin = margin(tokens, i, source);
    const auto opener_margin = margin(tokens, walk.closed(), source);
    if (end_margin && opener_margin && *end_margin > *opener_margin) {
      return IdleEnd{walk.closed(), i};
    }
  }
  return std::nullopt;
}

}  // namespace robosync::compiler
