// What the grammar accepts at a place, whatever follows it.
#pragma once

#include <cstdint>
#include <vector>

#include "compiler/source/source_file.hpp"
#include "compiler/syntax/token.hpp"

namespace robosync::compiler::query {

struct Expected {
  // Every token that could come next, except keywords that would be names here.
  std::vector<TokenKind> kinds;
  // The tokens before the place, from the first word of its item, without line ends that do not count and without the word that
  // is being typed.
  Tokens before;
  Span typed;  // that word, up to the place
  bool in_string = false;
  bool in_comment = false;

  [[nodiscard]] bool takes(TokenKind kind) const { return contains(kinds, kind); }
  // The token this many places back, counting from 1; END_OF_FILE if there is none.
  [[nodiscard]] TokenKind back(std::size_t places) const {
    return places <= before.size() ? before[before.size() - places].kind : Kinds::END_OF_FILE;
  }
};

[[nodiscard]] Expected expected_at(const SourceMap& sources, FileId file, std::uint32_t offset);

}  // namespace robosync::compiler::query
