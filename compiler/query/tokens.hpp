// The words of a text and their meanings, for semantic highlighting; and the blocks that can be folded.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "compiler/query/symbols.hpp"

namespace robosync::compiler::query {

struct ColouredToken {
  Span span;
  enum class Sort : std::uint8_t { keyword, number, text, name } sort{};
  std::optional<SymbolKind> meaning{};  // of a name
  bool declares = false;
};

// In the order of the text. Words without meaning, operators and brackets are left out.
[[nodiscard]] std::vector<ColouredToken> coloured_tokens(const SourceMap& sources, FileId file,
                                                         const Symbols& symbols);

// The first and the last line of a block of several lines, counting from 1. Blocks are found by their keywords, in any text.
struct Fold {
  std::uint32_t first = 0, last = 0;
};
[[nodiscard]] std::vector<Fold> folds(const SourceMap& sources, FileId file);

}  // namespace robosync::compiler::query
