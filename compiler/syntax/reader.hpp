// Runs the grammar over some tokens.
#pragma once

#include <cstddef>
#include <vector>

#include "compiler/diagnostics/diagnostic.hpp"
#include "compiler/source/source_file.hpp"
#include "compiler/syntax/ast.hpp"
#include "compiler/syntax/builder.hpp"
#include "compiler/syntax/token.hpp"
#include "compiler/syntax/token_reader.hpp"

namespace robosync::compiler {

struct Attempt {
  bool complete = false;
  std::vector<ast::Item> items;     // when complete
  std::vector<Span> keyword_names;  // when complete: those of Tree
  // If not complete: where the grammar stopped (an index into the tokens, or their number at the end),
  // the token it had taken before that one, and the tokens it would have accepted.
  std::size_t stopped_at = 0;
  std::size_t before = 0;
  std::vector<TokenKind> expected;
};

// Use one per file: constructing the grammar's stack takes longer than reading an item with it.
class Reader {
public:
  explicit Reader(const SourceFile& source) : source_(source), builder_(source) {}

  // Adds the end of the last line to the tokens if it is missing. Reports nothing if `diagnostics`
  // is null.
  [[nodiscard]] Attempt read(Tokens& tokens, Diagnostics* diagnostics);

  const SourceFile& source() const { return source_; }
  std::forward_list<std::string> take_labels() { return builder_.take_labels(); }

private:
  const SourceFile& source_;
  std::vector<std::uint32_t> order_;  // of the tokens that the grammar sees
  TokenReader tokens_;
  Builder builder_;
  grammar::Grammar grammar_{tokens_, builder_};
};

}  // namespace robosync::compiler
