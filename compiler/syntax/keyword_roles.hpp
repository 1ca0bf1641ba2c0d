// Keywords with their tokens and roles, for the parser. See keywords.def.
#pragma once

#include <optional>
#include <span>
#include <string_view>

#include "compiler/syntax/keywords.hpp"
#include "compiler/syntax/token.hpp"

namespace robosync::compiler {

namespace role {
enum Role : unsigned {
  none = 0,
  item = 1,
  part = 2,
  statement = 4,
  opens = 8,
  begins = 16,
  after = 32,
  before = 64,
  name = 128,
  word = 256,
  context = 512,
  given = 1024,
};
}  // namespace role

struct Keyword {
  std::string_view spelling;
  TokenKind kind;
  unsigned roles;
};

[[nodiscard]] std::span<const Keyword> keywords();

// The keyword spelled by a word; null for any other word.
[[nodiscard]] const Keyword* find_keyword(std::string_view word);

// The roles of a token. Keywords, operators and brackets have roles, other tokens none.
[[nodiscard]] unsigned roles_of(TokenKind kind);

// True when `behind` can follow the name in a declaration that begins with `first`.
[[nodiscard]] bool declares(TokenKind first, TokenKind behind);

// The keyword with one of `roles` that is nearest to a misspelt word; null when none is near.
[[nodiscard]] const Keyword* nearest_keyword(std::string_view word, unsigned roles);

}  // namespace robosync::compiler
