// What the lines of a program say before the grammar reads it: which ends of lines count, and where
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

// Puts the tokens that the grammar shall see into `order`, as places in `tokens`: an end of a line is left
// out after a token that cannot end a statement and before one that cannot start one. The last one always
// counts; when the text does not end with a line's end, it is added to `tokens`.
void significant(std::vector<Token>& tokens, std::vector<std::uint32_t>& order);

struct Region {
  std::size_t begin = 0, end = 0;  // places in the tokens
};

// The text as pieces that can be read one by one: an item, or several when something is wrong with
// them. A mistake in one cannot spoil the next, because words like DEFINE always start an item.
[[nodiscard]] std::vector<Region> split_into_regions(std::span<const Token> tokens,
                                                     const SourceFile& source);

inline constexpr std::size_t kDeepestBlock = 32;
inline constexpr std::size_t kDeepestBracket = 64;  // also of signs in a row, as NOT NOT NOT
struct TooDeep {
  std::size_t at = 0;      // place in the tokens
  bool in_blocks = false;  // or in brackets and signs
};
// The first token that opens more blocks or brackets than anybody needs.
[[nodiscard]] std::optional<TooDeep> nested_too_deeply(std::span<const Token> tokens);

}  // namespace robosync::compiler
