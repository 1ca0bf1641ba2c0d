// What the grammar expected, in few words. See wording.hpp.
#include <algorithm>
#include <array>

#include "compiler/syntax/keyword_roles.hpp"
#include "compiler/syntax/wording.hpp"

namespace robosync::compiler {

namespace {

// Tokens that are one thing to the user. When all of `needs` are expected, `phrase` is said for
// them and for those of `covers`.
struct Group {
  std::vector<TokenKind> needs;
  std::vector<TokenKind> covers;
  const char* phrase;  // null: not worth saying
};

// Every token whose keyword has one of `roles`, and some more.
std::vector<TokenKind> with_role(unsigned roles, std::vector<TokenKind> more) {
  for (const Keyword& keyword : keywords())
    if ((keyword.roles & roles) != 0) more.push_back(keyword.kind);
  return more;
}

const std::vector<Group>& groups() {
  using K = Kinds;
  static const std::vector<Group> all = {
      {{K::WHEN, K::DEFINE},
       with_role(role::item | role::part, {K::NEWLINE, K::END_OF_FILE}),
       "a word such as `WHEN`, `DEFINE` or `BEHAVIOR`"},
      {{K::NAME, K::SET, K::WAIT},
       with_role(role::statement, {K::QUANTITY, K::NEWLINE}),
       "a statement"},
      {{K::NAME, K::QUANTITY, K::TO},
       {K::STRING, K::BY, K::OVER, K::AT, K::FOR, K::MARGIN, K::WITH, K::TIMES, K::OPEN},
       "a word of the command"},
      {{K::NAME, K::QUANTITY, K::OPEN}, {K::MINUS, K::RANDOM, K::NOT, K::STRING}, "a value"},
      {{K::LESS, K::IS}, {K::BECOMES, K::CHANGES}, "a comparison such as `<` or `IS`"},
      {{K::LESS}, {}, "a comparison such as `<`"},
      {{K::KEPT}, {}, nullptr},  // it also stands where it is refused
      {{K::DO},
       {K::PRIORITY, K::COOLDOWN, K::MARGIN, K::WAITING, K::RESTARTING, K::NAME, K::QUANTITY,
        K::THEN, K::FOR, K::AND, K::OR},
       "`DO`"},
  };
  return all;
}

void remove(std::vector<TokenKind>& kinds, TokenKind kind) {
  kinds.erase(std::remove(kinds.begin(), kinds.end(), kind), kinds.end());
}

// Operators can go on almost anywhere; they are worth naming only when nothing else can.
bool is_continuation(TokenKind kind) {
  switch (kind) {
    case Kinds::PLUS:
    case Kinds::MINUS:
    case Kinds::STAR:
    case Kinds::SLASH:
    case Kinds::MOD:
    case Kinds::AND:
    case Kinds::OR:
    case Kinds::EQUAL:
    case Kinds::GREATER:
    case Kinds::LESS_EQUAL:
    case Kinds::GREATER_EQUAL:
    case Kinds::NOT_EQUAL:
      return true;
    default:
      return false;
  }
}

std::string join(const std::vector<std::string>& phrases) {
  constexpr std::size_t most = 4;
  std::string text;
  const std::size_t count = std::min(phrases.size(), most);
  for (std::size_t i = 0; i < count; ++i) {
    if (i > 0) text += i + 1 == phrases.size() ? " or " : ", ";
    text += phrases[i];
  }
  return phrases.size() > most ? text + " or the like" : text;
}

}  // namespace

std::string summarize(const std::vector<TokenKind>& expected) {
  std::vector<TokenKind> left = expected;
  std::vector<std::string> phrases;
  for (const Group& group : groups()) {
    const bool all = std::all_of(group.needs.begin(), group.needs.end(),
                                 [&left](TokenKind kind) { return contains(left, kind); });
    if (!all) continue;
    if (group.phrase != nullptr) phrases.emplace_back(group.phrase);
    for (const TokenKind kind : group.needs)
      remove(left, kind);
    for (const TokenKind kind : group.covers)
      remove(left, kind);
  }
  std::vector<std::string> others;
  for (const TokenKind kind : left) {
    if (!is_continuation(kind)) others.push_back(describe(kind));
  }
  phrases.insert(phrases.end(), others.begin(), others.end());
  if (!phrases.empty()) return join(phrases);
  for (const TokenKind kind : left)
    phrases.push_back(describe(kind));
  return phrases.empty() ? "something else" : join(phrases);
}

}  // namespace robosync::compiler
