// See line_starts.hpp.
#include "compiler/syntax/line_starts.hpp"

#include <algorithm>
#include <initializer_list>
#include <string>

#include "compiler/source/ascii.hpp"
#include "compiler/syntax/blocks.hpp"
#include "compiler/syntax/rewritten.hpp"

namespace robosync::compiler {
namespace {

bool are(const Tokens& tokens, std::size_t at, std::initializer_list<TokenKind> kinds) {
  return at + kinds.size() <= tokens.size() &&
         std::equal(kinds.begin(), kinds.end(), tokens.begin() + static_cast<std::ptrdiff_t>(at),
                    [](TokenKind kind, const Token& token) { return kind == token.kind; });
}

// `PRIORITY 5 BEHAVIOR greet`
void mend_order(Tokens& tokens, std::size_t at, const SourceFile& source,
                Diagnostics& diagnostics) {
  if (!are(tokens, at, {Kinds::PRIORITY, Kinds::QUANTITY, Kinds::BEHAVIOR, Kinds::NAME})) return;
  Span all = tokens[at].span;
  all.end = tokens[at + 3].span.end;
  const std::string better = "BEHAVIOR " + std::string(source.text(tokens[at + 3].span)) +
                             " PRIORITY " + std::string(source.text(tokens[at + 1].span));
  diagnostics.report(Code::E0001, "the PRIORITY comes after the name of a BEHAVIOR")
      .label(all)
      .helps("write `" + better + "`")
      .fix(all, better, Applicability::likely);
  const auto first = tokens.begin() + static_cast<std::ptrdiff_t>(at);
  std::rotate(first, first + 2, first + 4);
}

// `AT 10s DO`
void mend_time(Tokens& tokens, std::size_t at, const SourceFile& source, Diagnostics& diagnostics) {
  std::size_t next = at + 2;
  while (next < tokens.size() && tokens[next].kind == Kinds::NEWLINE)
    ++next;
  if (!are(tokens, at, {Kinds::AT, Kinds::QUANTITY}) || !are(tokens, next, {Kinds::DO})) return;
  const std::string time(source.text(tokens[at + 1].span));
  Span all = tokens[at].span;
  all.end = tokens[at + 1].span.end;
  diagnostics
      .report(Code::E0010, "a rule cannot begin with `" + std::string(source.text(all)) + "`")
      .label(all)
      .helps("to act once after the start, write `AT START DO`, then `WAIT " + time + "`")
      .helps("to act again and again, write `EVERY " + time + " DO`");
  tokens[at].kind = Kinds::EVERY;
}

// `GIVEN touch LEVEL = 5`, from its first word on. Adds the tokens of `AT 0s` in its place; false if there is none.
bool mend_given(Rewritten& rewritten, const Tokens& tokens, std::size_t at,
                const SourceFile& source, Diagnostics& diagnostics) {
  const std::size_t sign =
      are(tokens, at, {Kinds::NAME, Kinds::NAME, Kinds::NAME}) ? at + 3 : at + 2;
  const Span word = tokens[at].span;
  if (!are(tokens, at, {Kinds::NAME, Kinds::NAME}) ||
      !are(tokens, sign, {Kinds::EQUAL, Kinds::QUANTITY}) ||
      !ascii::same(source.text(word), "GIVEN"))
    return false;
  const Span step{word.file, tokens[at + 1].span.begin, tokens[sign + 1].span.end};
  diagnostics.report(Code::E0001, "a step of a TEST that sets a sensor begins with its time")
      .label(word)
      .helps("write `AT 0s " + std::string(source.text(step)) + "`")
      .fix(word, "AT 0s", Applicability::likely);
  Tokens& mended = rewritten.other(at);
  mended.push_back({Kinds::AT, word});
  mended.push_back({Kinds::QUANTITY, {word.file, word.end, word.end}});
  return true;
}

}  // namespace

void mend_line_starts(Tokens& tokens, const SourceFile& source, Diagnostics& diagnostics) {
  Rewritten rewritten(tokens);
  for (std::size_t at = 0; at < tokens.size(); ++at) {
    if (starts_line(tokens, at)) {
      mend_order(tokens, at, source, diagnostics);
      mend_time(tokens, at, source, diagnostics);
      if (mend_given(rewritten, tokens, at, source, diagnostics)) continue;
    }
    rewritten.keep(at);
  }
  rewritten.finish();
}

}  // namespace robosync::compiler
