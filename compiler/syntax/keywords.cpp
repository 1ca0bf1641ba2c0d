// See keywords.hpp and keyword_roles.hpp.
#include "compiler/syntax/keywords.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <iterator>

#include "compiler/diagnostics/nearest.hpp"
#include "compiler/source/ascii.hpp"
#include "compiler/syntax/keyword_roles.hpp"

namespace robosync::compiler {

// In this namespace, so that the roles column of keywords.def resolves to role::…, whatever a unity build puts before it.
namespace role {
namespace {
constexpr Keyword all[] = {
#define KEYWORD(spelling, token, roles) {#spelling, Kinds::token, roles},
#include "compiler/syntax/keywords.def"
#undef KEYWORD
};
}  // namespace
}  // namespace role

namespace {

using grammar::Grammar;

constexpr auto& table = role::all;

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
    roles[kind] = role::after | role::before;
  roles[Kinds::CLOSE] = role::after;
  roles[Kinds::OPEN] = role::before;
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

// Indices into the table, sorted by the first letter of the keyword. Every word of a program is looked
// up, and one comparison decides most lookups.
struct Index {
  static constexpr std::size_t letters = 26;
  std::array<std::uint8_t, std::size(table)> places{};
  std::array<std::uint8_t, letters + 1> begins{};  // where each letter begins, and the end
};

constexpr Index make_index() {
  Index index;
  std::size_t filled = 0;
  for (std::size_t letter = 0; letter < Index::letters; ++letter) {
    for (std::size_t place = 0; place < std::size(table); ++place)
      if (static_cast<std::size_t>(table[place].spelling.front() - 'A') == letter)
        index.places[filled++] = static_cast<std::uint8_t>(place);
    index.begins[letter + 1] = static_cast<std::uint8_t>(filled);
  }
  return index;
}

constexpr Index keyword_index = make_index();
static_assert(keyword_index.begins.back() == std::size(table), "keywords are in capitals");

}  // namespace

std::span<const Keyword> keywords() {
  return table;
}

const Keyword* find_keyword(std::string_view word) {
  const char first = word.empty() ? '\0' : ascii::lower(word.front());
  if (first < 'a' || first > 'z') return nullptr;
  const auto letter = static_cast<std::size_t>(first - 'a');
  for (std::size_t i = keyword_index.begins[letter]; i < keyword_index.begins[letter + 1]; ++i) {
    const Keyword& keyword = table[keyword_index.places[i]];
    if (ascii::same(word, keyword.spelling))
      return (keyword.roles & role::context) == 0 ? &keyword : nullptr;
  }
  return nullptr;
}

bool is_keyword(std::string_view word) {
  return find_keyword(word) != nullptr;
}

bool may_name_a_part(std::string_view word) {
  const Keyword* const keyword = find_keyword(word);
  constexpr unsigned kBegins = role::item | role::word;
  return keyword == nullptr || (keyword->roles & kBegins) == kBegins;
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
  const bool is_phrase =
      std::string_view(name).starts_with("a ") || std::string_view(name).starts_with("the ");
  return is_phrase ? std::string(name) : "`" + std::string(name) + "`";
}

bool declares(TokenKind first, TokenKind behind) {
  switch (first) {
    case Kinds::REMEMBER:
    case Kinds::LET:
      return behind == Kinds::EQUAL;
    case Kinds::STATE:
    case Kinds::LIST:
      return behind == Kinds::COLON;
    case Kinds::FEELING:
      return behind == Kinds::FROM;
    case Kinds::TIMER:
    case Kinds::DEFINE:
      return behind == Kinds::NEWLINE || behind == Kinds::WITH;
    case Kinds::CHECK:
    case Kinds::MOTION:
      return behind == Kinds::OF;
    default:
      return false;
  }
}

}  // namespace robosync::compiler
