// The tokens of a text of which some are written in another way. Nothing is copied as long as nothing changes.
#pragma once

#include <cstddef>
#include <utility>

#include "compiler/syntax/token.hpp"

namespace robosync::compiler {

class Rewritten {
public:
  explicit Rewritten(Tokens& tokens) : tokens_(tokens) {}

  // From `at` on the tokens are others, to be added to what this returns. Those before `at` are kept.
  Tokens& other(std::size_t at) {
    if (!begun_) mended_.assign(tokens_.begin(), tokens_.begin() + static_cast<std::ptrdiff_t>(at));
    begun_ = true;
    return mended_;
  }
  void keep(std::size_t at) {
    if (begun_) mended_.push_back(tokens_[at]);
  }
  void finish() {
    if (begun_) tokens_ = std::move(mended_);
  }

private:
  Tokens& tokens_;
  Tokens mended_;
  bool begun_ = false;
};

}  // namespace robosync::compiler
