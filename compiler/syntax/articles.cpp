// See articles.hpp.
#include "compiler/syntax/articles.hpp"

#include <vector>

#include "compiler/syntax/blocks.hpp"
#include "compiler/syntax/keyword_roles.hpp"
#include "compiler/syntax/rewritten.hpp"
#include "compiler/syntax/word_list.hpp"

namespace robosync::compiler {
namespace {

constexpr std::string_view kArticles = "the an";

bool is_article(const Tokens& tokens, std::size_t at, const SourceFile& source) {
  return tokens[at].kind == Kinds::NAME && has_word(kArticles, source.text(tokens[at].span));
}

// A row of a CHECK begins with its word, a STATE has words behind signs, and a DEFINE names its values. Where a value stands, it
// may be a name of a module.
bool may_be_name(const Tokens& tokens, std::size_t at) {
  if (at == 0 || starts_line(tokens, at)) return true;
  const TokenKind before = tokens[at - 1].kind;
  return is_preposition(before) || is_relation(before) ||
         is_one_of(before,
                   {Kinds::COLON, Kinds::COMMA, Kinds::WITH, Kinds::OPEN, Kinds::PLUS, Kinds::MINUS,
                    Kinds::STAR, Kinds::SLASH, Kinds::EVERY, Kinds::WITHIN}) ||
         declares(before, at + 1 < tokens.size() ? tokens[at + 1].kind : Kinds::NEWLINE);
}

void report(const std::vector<Span>& places, const SourceFile& source, Diagnostics& diagnostics) {
  constexpr std::size_t most = 4;  // places shown
  Diagnostic& message = diagnostics.report(Code::E0009, "RSL has no articles");
  message.label(places.front(), "leave this out");
  for (std::size_t at = 1; at < std::min(places.size(), most); ++at)
    message.label(places[at], "and this", false);
  if (places.size() > most) message.appears_in_more(places.size() - most);
  for (const Span place : places) {
    const std::size_t next = source.text().find_first_not_of(" \t", place.end);
    message.fix({place.file, place.begin, static_cast<std::uint32_t>(next)}, "",
                Applicability::likely);
  }
}

}  // namespace

void leave_out_articles(Tokens& tokens, const SourceFile& source, const Vocabulary* robot,
                        Diagnostics& diagnostics) {
  std::vector<Span> places;
  for (std::size_t at = 0; at + 1 < tokens.size(); ++at) {
    if (!is_article(tokens, at, source)) continue;
    if (may_be_name(tokens, at) || knows(robot, source.text(tokens[at].span))) return;
    if (tokens[at + 1].kind == Kinds::NAME) places.push_back(tokens[at].span);
  }
  if (places.empty()) return;
  report(places, source, diagnostics);
  Rewritten rewritten(tokens);
  auto next = places.begin();
  for (std::size_t at = 0; at < tokens.size(); ++at) {
    if (next == places.end() || tokens[at].span.begin != next->begin) {
      rewritten.keep(at);
      continue;
    }
    ++next;
    rewritten.other(at);
  }
  rewritten.finish();
}

}  // namespace robosync::compiler
