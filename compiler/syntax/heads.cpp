// See heads.hpp.
#include "compiler/syntax/heads.hpp"

#include <algorithm>

#include "compiler/syntax/blocks.hpp"

namespace robosync::compiler {

namespace {

// The head ends with its line, or where a rule begins in the same line.
bool ends_head(TokenKind kind) {
  return kind == Kinds::NEWLINE || kind == Kinds::WHEN || kind == Kinds::WHILE ||
         kind == Kinds::EVERY || kind == Kinds::AT;
}

bool is_misplaced(TokenKind kind) {
  return kind == Kinds::END || kind == Kinds::BEHAVIOR;
}

void report(const Token& token, const SourceFile& source, Diagnostics& diagnostics) {
  diagnostics
      .report(Code::E0010, "`" + std::string(source.text(token.span)) +
                               "` cannot stand in the first line of a BEHAVIOR")
      .label(token.span)
      .helps("the line is `BEHAVIOR name PRIORITY 50`; its rules follow, and then `END`");
}

}  // namespace

void mend_heads(Tokens& tokens, const SourceFile& source, Diagnostics& diagnostics) {
  for (std::size_t at = 0; at + 1 < tokens.size(); ++at) {
    if (tokens[at].kind != Kinds::BEHAVIOR || !starts_line(tokens, at)) continue;
    const auto begin = tokens.begin() + static_cast<std::ptrdiff_t>(at) + 1;
    const auto end =
        std::find_if(begin, tokens.end(), [](const Token& token) { return ends_head(token.kind); });
    const auto first =
        std::find_if(begin, end, [](const Token& token) { return is_misplaced(token.kind); });
    if (first == end) continue;
    report(*first, source, diagnostics);
    tokens.erase(
        std::remove_if(first, end, [](const Token& token) { return is_misplaced(token.kind); }),
        end);
  }
}

}  // namespace robosync::compiler
