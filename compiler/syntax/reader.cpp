// See reader.hpp.
#include "compiler/syntax/reader.hpp"

#include <utility>

#include "compiler/syntax/keyword_roles.hpp"
#include "compiler/syntax/layout.hpp"

namespace robosync::compiler {

namespace {

// Removes keywords that would be accepted here only as names: if the grammar accepts one typical keyword with a role,
// it accepts all of that role as names. Also removes a bracket that could follow a name only as in a function call.
void leave_out_names(std::vector<TokenKind>& expected) {
  if (contains(expected, Kinds::PLUS)) std::erase(expected, Kinds::OPEN);
  if (!contains(expected, Kinds::NAME)) return;
  unsigned roles = 0;
  if (contains(expected, Kinds::FOREVER)) roles |= role::word;
  if (contains(expected, Kinds::ONE)) roles |= role::given;
  if (contains(expected, Kinds::FEELING)) roles |= role::name;
  std::erase_if(expected, [roles](TokenKind kind) { return (roles_of(kind) & roles) != 0; });
}

}  // namespace

Attempt Reader::read(Tokens& tokens, Diagnostics* diagnostics) {
  significant(tokens, order_);
  tokens_ = TokenReader(tokens, order_);
  builder_.restart(diagnostics);
  Attempt attempt;
  attempt.complete = grammar_.parse() == 0;
  if (attempt.complete) {
    attempt.items = std::move(builder_.items());
    attempt.keyword_names = std::move(builder_.keyword_names());
    return attempt;
  }
  attempt.expected = builder_.expected();
  leave_out_names(attempt.expected);
  // The grammar has taken the token it stopped at, unless that is the end.
  const bool at_end = tokens_.past_end();
  const std::size_t index = at_end ? order_.size() : tokens_.taken() - 1;
  attempt.stopped_at = at_end ? tokens.size() : order_[index];
  attempt.before = index == 0 ? 0 : order_[index - 1];
  return attempt;
}

}  // namespace robosync::compiler
