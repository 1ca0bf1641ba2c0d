// Which block lost its END, or has one too many. Keywords alone cannot tell: indentation can, in a
// program that has some.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "compiler/source/source_file.hpp"
#include "compiler/syntax/attempt.hpp"

namespace robosync::compiler {

struct OpenBlock {
  std::size_t opener = 0;  // place of its first keyword
  std::size_t missed =
      0;  // the token before which END should stand; the number of tokens: at the end
};

// The innermost `count` blocks that lack an END when none may be open before the token `at`.
[[nodiscard]] std::vector<OpenBlock> open_blocks(const Tokens& tokens, std::size_t at,
                                                 std::size_t count, const SourceFile& source);

struct IdleEnd {
  std::size_t closed = 0;  // the opener that an earlier END, at `by`, closed too soon
  std::size_t by = 0;
};

// An END before the idle one at `at` that stands farther right than the block it closed.
[[nodiscard]] std::optional<IdleEnd> early_end(const Tokens& tokens, std::size_t at,
                                               const SourceFile& source);

}  // namespace robosync::compiler
