// See keywords.hpp and keyword_roles.hpp.
#include "compiler/syntax/keywords.hpp"

#include <algorithm>
#include <array>
#include <iterator>
#include <unordered_map>

#include "compiler/diagnostics/nearest.hpp"
#include "compiler/syntax/keyword_roles.hpp"

namespace robosync::compiler {

namespace {

using namespace role;  // the column `roles` of keywords.def
using grammar::Grammar;

constexpr Keyword table[] = {
#define KEYWORD(spelling, token, roles) {#spelling, Kinds::token, roles},
#include "compiler/syntax/keywords.def"
#undef KEYWORD
};

constexpr std::size_t token_kinds = Grammar::YYNTOKENS;
using RoleTable = std::array<unsigned, token_kinds>;

constexpr std::size_t number_of(TokenKind kind) {
  return static_cast<std::size_t>(kind);
}

// Binary operators and brackets hold lines together.
constexpr RoleTable make_roles() {
  RoleTable roles{};
  for (const Keyword& keyword : table)
    roles[number_of(keyword.kind)] = keyword.roles;
  for (std::size_t kind = Kinds::LESS; kind <= Kinds::COLON; ++kind)
    roles[kind] = after | before;
  roles[Kinds::CLOSE] = after;
  roles[Kinds::OPEN] = before;
  return roles;
}

constexpr RoleTable role_table = make_roles();

constexpr bool every_token_has_its_row() {
  for (std::size_t kind = Kinds::USE; kind < token_kinds; ++kind) {
    bool found = false;
    for (const Keyword& keyword : table)
      found = found || number_of(keyword.kind) == kind;
    if (!found) return false;
  }
  return true;
}
static_assert(every_token_has_its_row(), "a keyword of grammar/rsl.yy is not in keywords.def");

char upper(char c) {
  return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
}

std::string in_capitals(std::string_view word) {
  std::string capitals(word);
  std::transform(capitals.begin(), capitals.end(), capitals.begin(), upper);
  return capitals;
}

using Index = std::unordered_map<std::string_view, const Keyword*>;

const Index& index() {
  static const Index by_spelling = [] {
    Index entries;
    for (const Keyword& keyword : table)
      entries.emplace(keyword.spelling, &keyword);
    return entries;
  }();
  return by_spelling;
}

}  // namespace

std::span<const Keyword> keywords() {
  return table;
}

const Keyword* find_keyword(std::string_view word) {
  constexpr std::size_t longest = 16;
  if (word.size() > longest) return nullptr;
  const auto found = index().find(in_capitals(word));
  return found == index().end() ? nullptr : found->second;
}

bool is_keyword(std::string_view word) {
  return find_keyword(word) != nullptr;
}

const std::vector<std::string>& keyword_spellings() {
  static const std::vector<std::string> all = [] {
    std::vector<std::string> spellings;
    for (const Keyword& keyword : table)
      spellings.emplace_back(keyword.spelling);
    return spellings;
  }();
  return all;
}

unsigned roles_of(TokenKind kind) {
  const std::size_t number = number_of(kind);
  return number < token_kinds ? role_table[number] : 0U;
}

const Keyword* nearest_keyword(std::string_view word, unsigned roles) {
  const Keyword* best = nullptr;
  std::size_t fewest = 0;
  for (const Keyword& keyword : table) {
    if ((keyword.roles & roles) == 0 || !is_near(word, keyword.spelling)) continue;
    const std::size_t wrong = mistakes(word, keyword.spelling);
    if (best != nullptr && wrong >= fewest) continue;
    best = &keyword;
    fewest = wrong;
  }
  return best;
}

std::string describe(TokenKind kind) {
  const char* name = Grammar::symbol_name(static_cast<Grammar::symbol_kind_type>(kind));
  const bool is_phrase = std::string_view(name).find(' ') != std::string_view::npos;
  return is_phrase ? std::string(name) : "`" + std::string(name) + "`";
}

}  // namespace robosync::compiler
