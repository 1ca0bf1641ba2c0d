// Hands tokens to the grammar one by one and counts them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "compiler/syntax/token.hpp"

namespace robosync::compiler {

class TokenReader {
public:
  TokenReader() = default;

  // `order` lists the tokens that the grammar sees, as indices into `tokens`.
  TokenReader(std::span<const Token> tokens, std::span<const std::uint32_t> order)
      : tokens_(tokens), order_(order) {}

  // After the last token, returns the end of the file on every call.
  grammar::Grammar::symbol_type next() {
    if (taken_ == order_.size()) {
      past_end_ = true;
      return {Kinds::END_OF_FILE, end()};
    }
    const Token& token = tokens_[order_[taken_++]];
    return {token.kind, token.span};
  }

  std::size_t taken() const { return taken_; }
  bool past_end() const { return past_end_; }

private:
  Span end() const {
    if (tokens_.empty()) return {};
    const Span last = tokens_.back().span;
    return {last.file, last.end, last.end};
  }

  std::span<const Token> tokens_;
  std::span<const std::uint32_t> order_;
  std::size_t taken_ = 0;
  bool past_end_ = false;
};

}  // namespace robosync::compiler
