// The line structure of a program, found before the grammar reads it: which line ends count, and where
// one item ends and the next begins.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "compiler/source/source_file.hpp"
#include "compiler/syntax/token.hpp"

namespace robosync::compiler {

// Puts the tokens for the grammar into `order`, as indices into `tokens`. A line end is left
// out after a token that cannot end a statement and before one that cannot start one. The last line end always
// counts; when the text does not end with one, it is added to `tokens`.
void significant(std::vector<Token>& tokens, std::vector<std::uint32_t>& order);

struct Region {
  std::size_t begin = 0, end = 0;  // indices into the tokens
};

// Splits the text into pieces that can be read one by one: an item, or several when they have
// mistakes. A mistake in one piece cannot spoil the next, because words like DEFINE always start an item.
[[nodiscard]] std::vector<Region> split_into_regions(std::span<const Token> tokens,
                                                     const SourceFile& source);

inline constexpr std::size_t kDeepestBlock = 32;
inline constexpr std::size_t kDeepestBracket = 64;  // also for signs in a row: NOT NOT NOT
struct TooDeep {
  std::size_t at = 0;      // index in the tokens
  bool in_blocks = false;  // else in brackets or signs
};
// The first token that exceeds the limit for nested blocks, or for brackets and signs.
[[nodiscard]] std::optional<TooDeep> nested_too_deeply(std::span<const Token> tokens);

}  // namespace robosync::compiler
