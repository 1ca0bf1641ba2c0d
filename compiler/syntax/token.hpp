// A token: its kind and its place. Its text is read from the source when needed.
#pragma once

#include <algorithm>
#include <cstddef>
#include <initializer_list>
#include <vector>

#include "compiler/source/source_file.hpp"
#include "grammar/rsl.hpp"  // made from grammar/rsl.yy

namespace robosync::compiler {

using Kinds = grammar::Grammar::token;
using TokenKind = grammar::Grammar::token_kind_type;

inline bool contains(const std::vector<TokenKind>& kinds, TokenKind kind) {
  return std::find(kinds.begin(), kinds.end(), kind) != kinds.end();
}

inline bool is_one_of(TokenKind kind, std::initializer_list<TokenKind> kinds) {
  return std::find(kinds.begin(), kinds.end(), kind) != kinds.end();
}

// The tokens of keywords follow all others.
inline bool is_keyword(TokenKind kind) {
  return kind >= Kinds::USE;
}

// Does it stand in front of an argument of a command?
inline bool is_preposition(TokenKind kind) {
  return is_one_of(kind, {Kinds::TO, Kinds::BY, Kinds::OVER, Kinds::AT, Kinds::FOR, Kinds::MARGIN});
}

// <, >, <=, >=, = and <>
inline bool is_relation(TokenKind kind) {
  return kind >= Kinds::LESS && kind <= Kinds::NOT_EQUAL;
}

// Does a condition follow?
inline bool begins_question(TokenKind kind) {
  return is_one_of(kind, {Kinds::WHEN, Kinds::WHILE, Kinds::IF, Kinds::ELSE_IF, Kinds::UNTIL});
}

struct Token {
  TokenKind kind = TokenKind{};
  Span span;
};

// A piece of the program; its last token is the end of a line.
using Tokens = std::vector<Token>;

struct TokenRange {  // indices
  std::size_t begin = 0, end = 0;
};

// "`WHEN`", "a name", "`<`": the kind as messages show it.
[[nodiscard]] std::string describe(TokenKind kind);

}  // namespace robosync::compiler
