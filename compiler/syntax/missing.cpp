// What a missing token is to the user. See wording.hpp.
#include <algorithm>
#include <initializer_list>

#include "compiler/syntax/wording.hpp"

namespace robosync::compiler {

std::string what_is_missing(TokenKind kind, const std::vector<TokenKind>& expected) {
  const auto could_stand = [&](std::initializer_list<TokenKind> kinds) {
    return std::ranges::all_of(kinds, [&](TokenKind one) { return contains(expected, one); });
  };
  if (kind == Kinds::PLUS) return "an operator";
  if (kind == Kinds::LESS)
    return could_stand({Kinds::IS}) ? "a comparison such as `<` or `IS`"
                                    : "a comparison such as `<`";
  if (!is_one_of(kind, {Kinds::NAME, Kinds::QUANTITY, Kinds::STRING})) return describe(kind);
  if (could_stand({Kinds::NAME, Kinds::SET, Kinds::WAIT})) return "a statement";
  if (could_stand({Kinds::NAME, Kinds::QUANTITY, Kinds::TO})) return "a word of the command";
  if (could_stand({Kinds::NAME, Kinds::QUANTITY, Kinds::OPEN})) return "a value";
  return could_stand({Kinds::NAME, Kinds::STRING, Kinds::TRUE}) ? "a word" : describe(kind);
}

}  // namespace robosync::compiler
