// Finds blocks by their keywords, without the grammar: which are open (used to split a text into items), and which one
// lacks an END or has one too many. Keywords alone cannot show the latter; indentation can, where a program has it.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "compiler/source/source_file.hpp"
#include "compiler/syntax/token.hpp"

namespace robosync::compiler {

class BlockWalk {
public:
  explicit BlockWalk(std::span<const Token> tokens) : tokens_(tokens) {}

  // Moves past the token `at`; call once for each token, in order.
  void step(std::size_t at);

  // The openers of the blocks that are open now, outermost first.
  const std::vector<std::size_t>& open() const { return open_; }
  // True when the last step passed an END with no block open.
  bool end_was_idle() const { return idle_; }
  // The opener that the last step closed; only after an END that was not idle.
  std::size_t closed() const { return closed_; }

  // For a misspelt opener: treats the token of the last step as one.
  void count_as_opener(std::size_t at) { open_.push_back(at); }

private:
  bool opens(std::size_t at);

  std::span<const Token> tokens_;
  std::vector<std::size_t> open_;
  std::size_t closed_ = 0;
  bool idle_ = false;
  bool statement_ = true;  // the next token starts a line or statement
  bool safety_ = false;    // the next WHEN belongs to the SAFETY before it
};

[[nodiscard]] bool starts_line(std::span<const Token> tokens, std::size_t at);

// Bytes between the start of the token's line and the token.
[[nodiscard]] std::size_t indentation(const Token& token, const SourceFile& source);

struct OpenBlock {
  std::size_t opener = 0;  // index of its first keyword
  std::size_t missed = 0;  // END is missing before this token; the number of tokens: at the end
};

// The innermost `count` blocks that lack an END, if no block may be open before the token `at`.
[[nodiscard]] std::vector<OpenBlock> open_blocks(const Tokens& tokens, std::size_t at,
                                                 std::size_t count, const SourceFile& source);

struct IdleEnd {
  std::size_t closed = 0;  // the opener that an earlier END, at `by`, closed too soon
  std::size_t by = 0;
};

// The END before the idle one at `at` that is indented deeper than the block it closed.
[[nodiscard]] std::optional<IdleEnd> early_end(const Tokens& tokens, std::size_t at,
                                               const SourceFile& source);

}  // namespace robosync::compiler
