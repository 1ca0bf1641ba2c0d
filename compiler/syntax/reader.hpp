// Runs of the grammar over some tokens.
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
  std::vector<ast::Item> items;  // when complete
  // Where the grammar stopped otherwise: a place in the tokens, or their number at the end; the
  // token it had taken before that one; and what it could have gone on with.
  std::size_t stopped_at = 0;
  std::size_t before = 0;
  std::vector<TokenKind> expected;
};

// One for a file: making the grammar's stack takes longer than reading an item with it.
class Reader {
public:
  explicit Reader(const SourceFile& source) : source_(source), builder_(source) {}

  // Adds the end of the last line to the tokens when it is missing. Says nothing when `diagnostics`
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
