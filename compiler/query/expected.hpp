// What the grammar would take at a place, whatever stands behind it.
#pragma once

#include <cstdint>
#include <vector>

#include "compiler/source/source_file.hpp"
#include "compiler/syntax/token.hpp"

namespace robosync::compiler::query {

struct Expected {
  // Every token that could come next; names of keywords that could be names there are left out.
  std::vector<TokenKind> kinds;
  // What stands in front of it, from the first word of its item, without ends of lines that do not count, and without
  // the word that is being typed.
  Tokens before;
  Span typed;  // that word: up to the place
  bool in_string = false;
  bool in_comment = false;

  [[nodiscard]] bool takes(TokenKind kind) const { return contains(kinds, kind); }
  // The token so many places back, from 1; the end of the file where there is none.
  [[nodiscard]] TokenKind back(std::size_t places) const {
    return places <= before.size() ? before[before.size() - places].kind : Kinds::END_OF_FILE;
  }
};

[[nodiscard]] Expected expected_at(const SourceMap& sources, FileId file, std::uint32_t offset);

}  // namespace robosync::compiler::query
