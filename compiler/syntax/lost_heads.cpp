// See heads.hpp. Rows are recognised by their first words. Rows below a line that may be a misspelt head are left alone.
#include <algorithm>
#include <optional>
#include <vector>

#include "compiler/syntax/blocks.hpp"
#include "compiler/syntax/heads.hpp"

namespace robosync::compiler {

namespace {

TokenKind kind_at(const Tokens& tokens, std::size_t at) {
  return at < tokens.size() ? tokens[at].kind : TokenKind(Kinds::NEWLINE);
}

// If the line at `at` can only be a row of one kind of block: the first word of that block.
std::optional<TokenKind> block_of_row(const Tokens& tokens, std::size_t at) {
  if (tokens[at].kind == Kinds::EXPECT) return Kinds::TEST;
  if (tokens[at].kind == Kinds::AT && kind_at(tokens, at + 1) == Kinds::QUANTITY)
    return kind_at(tokens, at + 2) == Kinds::NAME ? Kinds::TEST : Kinds::MOTION;
  constexpr std::size_t kMostWords = 3;  // of a band's name
  std::size_t sign = at;
  while (sign < at + kMostWords && kind_at(tokens, sign) == Kinds::NAME)
    ++sign;
  if (sign == at) return std::nullopt;
  const bool bound = is_one_of(kind_at(tokens, sign), {Kinds::BELOW, Kinds::ABOVE}) &&
                     kind_at(tokens, sign + 1) == Kinds::QUANTITY &&
                     kind_at(tokens, sign + 2) == Kinds::NEWLINE;
  if (bound || kind_at(tokens, sign) == Kinds::OTHERWISE) return Kinds::CHECK;
  return std::nullopt;
}

// Are all lines from `at` up to the next END possible rows?
bool leads_to_end(const Tokens& tokens, std::size_t at) {
  for (; at < tokens.size(); ++at) {
    if (!starts_line(tokens, at) || tokens[at].kind == Kinds::NEWLINE) continue;
    if (tokens[at].kind == Kinds::END) return true;
    if (!is_one_of(tokens[at].kind, {Kinds::NAME, Kinds::AT, Kinds::EXPECT, Kinds::WAIT,
                                     Kinds::SEED, Kinds::MARGIN, Kinds::SMOOTH}))
      return false;
  }
  return false;
}

// A head for it, of tokens without width.
Tokens head_for(TokenKind block, const Token& row) {
  std::vector<TokenKind> kinds{block, Kinds::NAME, Kinds::OF, Kinds::NAME, Kinds::NEWLINE};
  if (block == Kinds::TEST) kinds = {block, Kinds::STRING, Kinds::NEWLINE};
  Tokens head;
  for (const TokenKind kind : kinds)
    head.push_back({kind, {row.span.file, row.span.begin, row.span.begin}});
  return head;
}

}  // namespace

void mend_lost_heads(Tokens& tokens, Diagnostics& diagnostics) {
  BlockWalk walk(tokens);
  TokenKind line = Kinds::END;  // first word of the line before, which may be a misspelt head
  for (std::size_t at = 0; at < tokens.size(); ++at) {
    const TokenKind kind = tokens[at].kind;
    if (starts_line(tokens, at) && kind != Kinds::NEWLINE) {
      const bool alone = walk.open().empty() &&
                         is_one_of(line, {Kinds::END, Kinds::USE, Kinds::LET, Kinds::REMEMBER,
                                          Kinds::STATE, Kinds::LIST, Kinds::TIMER, Kinds::LIMIT});
      const auto block = alone ? block_of_row(tokens, at) : std::nullopt;
      line = kind;
      if (block && leads_to_end(tokens, at)) {
        const std::string head = *block == Kinds::TEST    ? "TEST \"what it is about\""
                                 : *block == Kinds::CHECK ? "CHECK name OF sensor"
                                                          : "MOTION name OF actuator";
        diagnostics.report(Code::E0008, "the line `" + head + "` is missing above this")
            .label(tokens[at].span);
        const Tokens inserted = head_for(*block, tokens[at]);
        tokens.insert(tokens.begin() + static_cast<std::ptrdiff_t>(at), inserted.begin(),
                      inserted.end());
        return;
      }
    }
    walk.step(at);
  }
}

}  // namespace robosync::compiler
