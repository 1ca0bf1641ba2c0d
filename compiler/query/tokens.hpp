// The words of a text with what each means, for editors that colour by meaning; and what can be folded away.
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

// In the order of the text; words that mean nothing, operators and brackets are left out.
[[nodiscard]] std::vector<ColouredToken> coloured_tokens(const SourceMap& sources, FileId file,
                                                         const Symbols& symbols);

// From the first to the last line of what takes several of them, from 1: blocks as their keywords tell them, in any text.
struct Fold {
  std::uint32_t first = 0, last = 0;
};
[[nodiscard]] std::vector<Fold> folds(const SourceMap& sources, FileId file);

}  // namespace robosync::compiler::query
