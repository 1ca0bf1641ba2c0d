#include "compiler/codegen/code_draft.hpp"

namespace robosync::compiler {

void CodeDraft::mark(const Source& source) {
  if (!marks_.empty() && marks_.back().at == size()) marks_.pop_back();
  if (marks_.empty() || marks_.back().source.line != source.line)
    marks_.push_back({size(), source});
}

}  // namespace robosync::compiler
