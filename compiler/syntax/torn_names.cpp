// See torn_names.hpp. Two passes, however many names there are.
#include "compiler/syntax/torn_names.hpp"

#include <algorithm>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/syntax/blocks.hpp"
#include "compiler/syntax/keyword_roles.hpp"
#include "compiler/syntax/rewritten.hpp"

namespace robosync::compiler {
namespace {

constexpr std::size_t kMostWords = 4;

struct Torn {
  Span declared;
  std::vector<Span> places;  // all of them
};
using TornNames = std::map<std::string_view, Torn>;

bool is_with_dash(const Tokens& tokens, std::size_t at) {
  return at + 2 < tokens.size() && tokens[at].kind == Kinds::NAME &&
         tokens[at + 1].kind == Kinds::MINUS && tokens[at + 2].kind == Kinds::NAME &&
         tokens[at].span.end == tokens[at + 1].span.begin &&
         tokens[at + 1].span.end == tokens[at + 2].span.begin;
}

// How many words stand next to each other from `at` on; with `of`, also those of `number of visitors`.
std::size_t words_at(const Tokens& tokens, std::size_t at, bool of) {
  const auto is = [&](std::size_t place, TokenKind kind) {
    return place < tokens.size() && tokens[place].kind == kind;
  };
  std::size_t words = 0;
  while (words < kMostWords &&
         (is(at + words, Kinds::NAME) ||
          (of && words > 0 && is(at + words, Kinds::OF) && is(at + words + 1, Kinds::NAME))))
    ++words;
  return words;
}

Span whole(const Tokens& tokens, std::size_t at, std::size_t count) {
  return {tokens[at].span.file, tokens[at].span.begin, tokens[at + count - 1].span.end};
}

// How many tokens the torn name has that the line at `at` declares; 0 if it declares none. What follows the name of a DEFINE may
// be meant as a value, so its words have a message of their own.
std::size_t declared_at(const Tokens& tokens, std::size_t at) {
  if (!starts_line(tokens, at)) return 0;
  const bool dash = is_with_dash(tokens, at + 1);
  const bool of = is_one_of(tokens[at].kind, {Kinds::REMEMBER, Kinds::LET});
  const std::size_t count = dash ? 3 : words_at(tokens, at + 1, of), behind = at + 1 + count;
  if (count < 2 || behind >= tokens.size() || (!dash && tokens[at].kind == Kinds::DEFINE)) return 0;
  return declares(tokens[at].kind, tokens[behind].kind) ? count : 0;
}

// How many tokens that name has, one of `names`, which begins at `at`; 0 if none does.
std::size_t used_at(const Tokens& tokens, std::size_t at, const SourceFile& source,
                    const TornNames& names) {
  const auto is_one = [&](std::size_t count) {
    return names.contains(source.text(whole(tokens, at, count)));
  };
  if (is_with_dash(tokens, at)) return is_one(3) ? 3 : 0;
  for (std::size_t count = words_at(tokens, at, true); count >= 2; --count)
    if (is_one(count)) return count;
  return 0;
}

std::string better_for(std::string_view name) {
  std::string better;
  bool apart = false;
  for (const char c : name) {
    const bool sign = c == '-' || c == ' ' || c == '\t';
    if (!sign && apart) better += '_';
    if (!sign) better += c;
    apart = sign;
  }
  return better;
}

void report(const Torn& torn, std::string_view name, Diagnostics& diagnostics) {
  constexpr std::size_t most = 4;  // places shown
  const std::string better = better_for(name);
  const bool dash = name.find('-') != std::string_view::npos;
  Diagnostic& message = diagnostics.report(
      Code::E0001, dash ? "a name has only letters, digits and `_`" : "a name is one word");
  message.label(torn.declared).helps("write `" + better + "`");
  std::size_t shown = 1;
  for (const Span place : torn.places) {
    message.fix(place, better, Applicability::likely);
    if (place.begin != torn.declared.begin && shown++ < most)
      message.label(place, "and here", false);
  }
  if (shown > most) message.appears_in_more(shown - most);
}

}  // namespace

void mend_torn_names(Tokens& tokens, const SourceFile& source, Diagnostics& diagnostics) {
  TornNames names;
  for (std::size_t at = 0; at < tokens.size(); ++at)
    if (const std::size_t count = declared_at(tokens, at); count > 0) {
      const Span name = whole(tokens, at + 1, count);
      names.try_emplace(source.text(name), Torn{name, {}});
    }
  if (names.empty()) return;
  Rewritten rewritten(tokens);
  for (std::size_t at = 0; at < tokens.size(); ++at) {
    const std::size_t count = used_at(tokens, at, source, names);
    if (count == 0) {
      rewritten.keep(at);
      continue;
    }
    const Span place = whole(tokens, at, count);
    names.find(source.text(place))->second.places.push_back(place);
    rewritten.other(at).push_back({Kinds::NAME, place});
    at += count - 1;
  }
  rewritten.finish();
  for (const auto& [name, torn] : names)
    report(torn, name, diagnostics);
}

}  // namespace robosync::compiler
