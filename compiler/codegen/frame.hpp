// The frame of one behaviour: which cells its code uses, and where each of them stands.
//
// inputs that it sets | its other inputs | locals | truths of its watch rules | registers
#pragma once

#include <set>
#include <vector>

#include "compiler/codegen/code_draft.hpp"
#include "compiler/codegen/code_pool.hpp"

namespace robosync::compiler {

class Frame {
public:
  // While code is made: each notes that there must be such a cell.
  Cell read(std::uint32_t input);
  Cell write(std::uint32_t input);
  Cell add_local();  // one more; locals are never shared between responses
  Cell add_watch();
  Cell temporary(std::uint32_t depth);

  // When all code is made.
  [[nodiscard]] std::vector<std::uint32_t> inputs() const;  // in the order of their cells
  [[nodiscard]] std::size_t writable() const { return written_.size(); }
  [[nodiscard]] std::uint32_t locals() const { return locals_; }
  // Of the whole frame. More than vm::kMaxCells: it does not fit.
  [[nodiscard]] std::size_t cells() const;
  // `code` with every cell at its place. Only for a frame that fits.
  [[nodiscard]] CodeObject resolve(const CodeDraft& code) const;

private:
  std::set<std::uint32_t> read_, written_;  // numbers of inputs
  std::uint32_t locals_ = 0, watches_ = 0, temporaries_ = 0;
};

}  // namespace robosync::compiler
