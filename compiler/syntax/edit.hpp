// A change to the tokens that may let the grammar go on, and all the changes worth trying.
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
  std::size_t at = 0;                // place in the tokens
  std::size_t removed = 0;           // tokens taken away there
  Tokens inserted;                   // tokens put there
  int cost = 0;                      // the smaller, the more likely this is what the writer meant
  const Keyword* keyword = nullptr;  // for respell
  // What the grammar could take at that place; null when that was not found out.
  std::shared_ptr<const std::vector<TokenKind>> expected;
};

// Cheapest first. `failure` is where the grammar stopped.
[[nodiscard]] std::vector<Edit> possible_edits(Tokens& tokens, const Attempt& failure,
                                               Reader& reader);

[[nodiscard]] Tokens edited(const Tokens& tokens, const Edit& edit);

}  // namespace robosync::compiler
