// See attempt.hpp.
#include "compiler/syntax/attempt.hpp"

#include <utility>

#include "compiler/syntax/layout.hpp"

namespace robosync::compiler {

Attempt Reader::read(Tokens& tokens, Diagnostics* diagnostics) {
  const std::vector<std::uint32_t> order = significant(tokens);
  tokens_ = TokenReader(tokens, order);
  builder_.restart(diagnostics);
  Attempt attempt;
  attempt.complete = grammar_.parse() == 0;
  if (attempt.complete) {
    attempt.items = std::move(builder_.items());
    return attempt;
  }
  attempt.expected = builder_.expected();
  // The grammar has taken the token it stopped at, unless that is the end.
  const bool at_end = tokens_.past_end();
  const std::size_t index = at_end ? order.size() : tokens_.taken() - 1;
  attempt.stopped_at = at_end ? tokens.size() : order[index];
  attempt.before = index == 0 ? 0 : order[index - 1];
  return attempt;
}

}  // namespace robosync::compiler
