// See block_walk.hpp.
#include "compiler/syntax/block_walk.hpp"

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

}  // namespace robosync::compiler
