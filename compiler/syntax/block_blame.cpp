// See block_blame.hpp.
#include "compiler/syntax/block_blame.hpp"

#include <algorithm>

#include "compiler/syntax/block_walk.hpp"

namespace robosync::compiler {

namespace {

// Indentation of the line that the token starts; nothing when it stands inside a line.
std::optional<std::size_t> margin(const Tokens& tokens, std::size_t at, const SourceFile& source) {
  if (!starts_line(tokens, at)) return std::nullopt;
  return indentation(tokens[at], source);
}

// True when both start lines and `end` stands to the left of the block it closes.
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
