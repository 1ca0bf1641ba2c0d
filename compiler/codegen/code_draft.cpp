#include "compiler/codegen/code_draft.hpp"

#include "compiler/codegen/operations.hpp"

namespace robosync::compiler {
namespace {

constexpr std::size_t kShortReach = 255;  // words that a jump with two operands can skip

}  // namespace

void CodeDraft::mark(const Source& source) {
  if (!marks_.empty() && marks_.back().at == size()) marks_.pop_back();
  if (marks_.empty() || marks_.back().source.line != source.line)
    marks_.push_back({size(), source});
}

void CodeDraft::land(std::size_t from) {
  const bool compares = compared_by(instructions_[from].opcode).has_value();
  if (compares && size() - from - 1 <= kShortReach) {
    instructions_[from].operands[2] = distance(from + 1, size());
    return;
  }
  if (compares) split(from++);
  instructions_[from].operands[1] = distance(from + 1, size());
}

// A jump that compares leaves the first register free for the truth.
void CodeDraft::split(std::size_t from) {
  const Cell truth{Zone::temporary, 0};
  Instruction& compare = instructions_[from];
  compare.opcode = *compared_by(compare.opcode);
  compare.operands = {truth, compare.operands[0], compare.operands[1]};
  const auto behind = instructions_.begin() + static_cast<std::ptrdiff_t>(from) + 1;
  instructions_.insert(behind, {vm::Opcode::unless, {truth}});
  for (Mark& mark : marks_)
    if (mark.at > from) ++mark.at;
}

}  // namespace robosync::compiler
