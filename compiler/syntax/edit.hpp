// A change to the tokens that may let the grammar continue, and all changes worth trying.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "compiler/source/source_file.hpp"
#include "compiler/syntax/keyword_roles.hpp"
#include "compiler/syntax/reader.hpp"

namespace robosync::compiler {

struct Edit {
  enum class What { respell, insert, close_blocks, remove, replace, swap, skip };
  What what{};
  std::size_t at = 0;                // index in the tokens
  std::size_t removed = 0;           // tokens removed there
  Tokens inserted;                   // tokens inserted there
  int cost = 0;                      // the lower, the more likely the writer meant this
  const Keyword* keyword = nullptr;  // for respell
  // The tokens that the grammar accepts at that place; null when unknown.
  std::shared_ptr<const std::vector<TokenKind>> expected;
};

// Cheapest first. `failure` is where the grammar stopped.
[[nodiscard]] std::vector<Edit> possible_edits(Tokens& tokens, const Attempt& failure,
                                               Reader& reader);

[[nodiscard]] Tokens edited(const Tokens& tokens, const Edit& edit);

}  // namespace robosync::compiler
