#include "compiler/query/tokens.hpp"

#include <algorithm>

#include "compiler/syntax/blocks.hpp"
#include "compiler/syntax/lexer.hpp"

namespace robosync::compiler::query {
namespace {

std::optional<ColouredToken::Sort> sort_of(TokenKind kind) {
  if (kind == Kinds::QUANTITY) return ColouredToken::Sort::number;
  if (kind == Kinds::STRING) return ColouredToken::Sort::text;
  if (is_keyword(kind)) return ColouredToken::Sort::keyword;
  return std::nullopt;
}

}  // namespace

std::vector<ColouredToken> coloured_tokens(const SourceMap& sources, FileId file,
                                           const Symbols& symbols) {
  std::vector<ColouredToken> result;
  Diagnostics ignored;
  for (const Token& token : lex(sources.file(file), file, ignored)) {
    // Where a name is expected, a keyword may be one. A label is a name of several words.
    const Occurrence* const name = symbols.at(file, token.span.begin);
    const bool is_name = name != nullptr && name->span.begin <= token.span.begin &&
                         token.span.end <= name->span.end && token.kind != Kinds::STRING;
    if (is_name)
      result.push_back({token.span, ColouredToken::Sort::name, symbols.all().at(name->symbol).kind,
                        name->declares});
    else if (const auto sort = sort_of(token.kind))
      result.push_back({token.span, *sort});
  }
  return result;
}

std::vector<Fold> folds(const SourceMap& sources, FileId file) {
  const SourceFile& source = sources.file(file);
  Diagnostics ignored;
  const std::vector<Token> tokens = lex(source, file, ignored);
  BlockWalk walk(tokens);
  std::vector<Fold> result;
  for (std::size_t at = 0; at < tokens.size(); ++at) {
    walk.step(at);
    if (tokens[at].kind != Kinds::END || walk.end_was_idle()) continue;
    const Fold fold{source.line_of(tokens[walk.closed()].span.begin),
                    source.line_of(tokens[at].span.begin)};
    if (fold.first < fold.last) result.push_back(fold);
  }
  return result;
}

}  // namespace robosync::compiler::query
