// See expect_within.hpp. The grammar cannot tell: `IN 1s` may be a word and a number of the command.
#include "compiler/syntax/expect_within.hpp"

#include <algorithm>
#include <span>
#include <string>
#include <string_view>

#include <fmt/format.h>

#include "compiler/source/ascii.hpp"

namespace robosync::compiler {
namespace {

bool has(std::span<const Token> line, TokenKind kind) {
  return std::ranges::find(line, kind, &Token::kind) != line.end();
}

// The word IN before the time at the end of this line, if it says no other time; else null.
Token* in_of(std::span<Token> line, const SourceFile& source) {
  if (line.size() < 4 || line.front().kind != Kinds::EXPECT) return nullptr;
  Token& word = line[line.size() - 2];
  const bool is_in = word.kind == Kinds::NAME && ascii::same(source.text(word.span), "IN");
  if (!is_in || line.back().kind != Kinds::QUANTITY || has(line, Kinds::WITHIN)) return nullptr;
  return &word;
}

}  // namespace

void mend_expectations(Tokens& tokens, const SourceFile& source, Diagnostics& diagnostics) {
  for (std::size_t begin = 0; begin < tokens.size(); ++begin) {
    std::size_t end = begin;
    while (end < tokens.size() && tokens[end].kind != Kinds::NEWLINE)
      ++end;
    const std::span line = std::span(tokens).subspan(begin, end - begin);
    begin = end;
    Token* const word = in_of(line, source);
    if (word == nullptr) continue;
    const bool silence = has(line, Kinds::NOTHING);
    const std::string better = silence ? "FOR" : "WITHIN";
    const std::string_view begun =
        source.text().substr(line.front().span.begin, word->span.begin - line.front().span.begin);
    diagnostics
        .report(Code::E0001, fmt::format("a TEST says how long it waits with `{}`, not with `{}`",
                                         better, source.text(word->span)))
        .label(word->span)
        .helps(fmt::format("write `{}{} {}`", begun, better, source.text(line.back().span)))
        .fix(word->span, better, Applicability::likely);
    word->kind = silence ? Kinds::FOR : Kinds::WITHIN;
  }
}

}  // namespace robosync::compiler
