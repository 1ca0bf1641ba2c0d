// The code and constant sections under construction. Equal constants and equal code objects are
// kept once; objects that use timers never are equal, for a timer is used once.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "compiler/codegen/code_draft.hpp"
#include "vm/image.hpp"

namespace robosync::compiler {

inline constexpr std::size_t kMaxConst8 = 256;  // constants that an operand of one byte reaches

// A condition or response: its words, and which of them begins a source line.
struct CodeObject {
  std::vector<vm::Word> words;
  std::vector<Mark> marks;
};

class CodePool {
public:
  [[nodiscard]] std::size_t constant(vm::Value value);
  // The same for an operand of one byte; nothing when it stands too far behind.
  [[nodiscard]] std::optional<std::uint32_t> near_constant(vm::Value value);
  // Where the object stands in the code section.
  [[nodiscard]] std::size_t add(const CodeObject& object);

  [[nodiscard]] const std::vector<vm::Value>& constants() const { return constants_; }
  [[nodiscard]] const std::vector<vm::Word>& code() const { return code_; }
  [[nodiscard]] std::vector<vm::SourceLine> lines() const;
  // What the word of the code section comes from; empty when it is not known.
  [[nodiscard]] Span span_of(std::size_t word) const;

private:
  std::map<vm::Value, std::size_t> constant_places_;
  std::map<std::vector<vm::Word>, std::size_t> object_places_;
  std::vector<vm::Value> constants_;
  std::vector<vm::Word> code_;
  std::vector<Mark> marks_;  // `at` counts from the start of the section
};

}  // namespace robosync::compiler
