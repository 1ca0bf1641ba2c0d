// Inserts, at the cursor, a token that no rule accepts. The grammar stops there and reports what it would have accepted.
#include "compiler/query/expected.hpp"

#include <algorithm>

#include "compiler/syntax/keyword_roles.hpp"
#include "compiler/syntax/layout.hpp"
#include "compiler/syntax/lexer.hpp"
#include "compiler/syntax/reader.hpp"
#include "compiler/syntax/repair.hpp"

namespace robosync::compiler::query {
namespace {

// Limits for repairing mistakes before the cursor.
constexpr int kMends = 6;
constexpr std::size_t kMendingWork = 40'000;

bool is_word(TokenKind kind) {
  return kind == Kinds::NAME || is_keyword(kind);
}

// The tokens that the grammar would accept after these.
std::vector<TokenKind> behind(Tokens tokens, const SourceFile& source, std::uint32_t offset) {
  const FileId file = tokens.empty() ? FileId{} : tokens.front().span.file;
  tokens.push_back({Kinds::SIGN, {file, offset, offset}});
  Reader reader(source);
  Budget budget{kMendingWork};
  Diagnostics ignored;
  const Examples examples({}, source, nullptr);  // never read
  for (int mends = 0; mends < kMends; ++mends) {
    const Attempt attempt = reader.read(tokens, nullptr);
    if (attempt.complete || attempt.stopped_at >= tokens.size()) return {};
    if (tokens[attempt.stopped_at].kind == Kinds::SIGN) return attempt.expected;
    // The line cannot end yet, so no token can begin the next one.
    if (tokens[attempt.stopped_at].kind == Kinds::NEWLINE &&
        tokens[attempt.stopped_at + 1].kind == Kinds::SIGN)
      return {};
    mend(tokens, attempt, reader, examples, ignored, budget);
  }
  return {};
}

bool joins_conditions(TokenKind kind) {
  return is_one_of(kind, {Kinds::AND, Kinds::OR, Kinds::MOD});
}

// At the start of a line: adds keywords that continue the line before.
void add_going_on(const Tokens& piece, const SourceFile& source, std::uint32_t offset,
                  std::vector<TokenKind>& kinds) {
  Tokens open = piece;
  while (!open.empty() && open.back().kind == Kinds::NEWLINE)
    open.pop_back();
  if (open.empty() || open.size() == piece.size()) return;
  for (const TokenKind kind : behind(open, source, offset)) {
    const bool goes_on = is_keyword(kind) && (roles_of(kind) & role::after) != 0;
    if (goes_on && !joins_conditions(kind) && !contains(kinds, kind)) kinds.push_back(kind);
  }
}

Tokens without_idle_ends_before(Tokens piece) {
  const std::size_t size = piece.size();
  std::vector<std::uint32_t> order;
  significant(piece, order);
  Tokens seen;
  for (const std::uint32_t place : order)
    if (place < size) seen.push_back(piece[place]);
  return seen;
}

// Outside tokens, a comment sign always begins a comment.
bool is_comment(const SourceFile& source, const Tokens& head, std::uint32_t offset) {
  const std::uint32_t line = source.line_start(source.line_of(offset));
  const std::uint32_t begin = head.empty() ? line : std::max(line, head.back().span.end);
  if (begin >= offset) return false;
  const std::string_view between = source.text().substr(begin, offset - begin);
  return between.find_first_of("%#") != std::string_view::npos;
}

}  // namespace

Expected expected_at(const SourceMap& sources, FileId file, std::uint32_t offset) {
  const SourceFile& source = sources.file(file);
  Expected result;
  result.typed = {file, offset, offset};
  Diagnostics ignored;
  Tokens head;
  for (const Token& token : lex(source, file, ignored)) {
    if (token.span.begin >= offset) break;
    const bool reaches = token.span.end >= offset;
    const bool open = token.kind == Kinds::STRING && token.span.end == offset &&
                      (token.span.end - token.span.begin == 1 ||
                       source.text()[token.span.end - 1] != source.text()[token.span.begin]);
    result.in_string = token.kind == Kinds::STRING && (token.span.end > offset || open);
    if ((reaches && is_word(token.kind)) || result.in_string) {
      result.typed.begin = token.span.begin;
      break;
    }
    head.push_back(token);
  }
  result.in_comment = !result.in_string && is_comment(source, head, result.typed.begin);
  if (result.in_comment) return result;
  const std::vector<Region> regions = split_into_regions(head, source);
  const std::size_t begin = regions.empty() ? 0 : regions.back().begin;
  const Tokens piece(head.begin() + static_cast<std::ptrdiff_t>(begin), head.end());
  result.kinds = behind(piece, source, offset);
  add_going_on(piece, source, offset, result.kinds);
  result.before = without_idle_ends_before(piece);
  return result;
}

}  // namespace robosync::compiler::query
