// Code under construction: the instructions of one condition or response, the frame of their behaviour, and the code section of
// the image.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <vector>

#include "compiler/source/source_file.hpp"
#include "vm/image.hpp"
#include "vm/opcode.hpp"

namespace robosync::compiler {

// ---- instructions
//
// Instructions before the frame of their behaviour is laid out: an operand may be a cell that only has a purpose, not a place.
// Frame::resolve() turns them into words.

// The zones of a frame, in order.
enum class Zone : std::uint8_t { input, local, watch, temporary };

// A cell of the frame. `number`: for an input, the input's number in the image; otherwise its index in the zone.
struct Cell {
  Zone zone = Zone::temporary;
  std::uint32_t number = 0;
};

struct Operand {
  Operand() = default;
  Operand(std::uint32_t a_value) : value(a_value) {}
  Operand(Cell cell) : zone(cell.zone), value(cell.number) {}

  std::optional<Zone> zone;  // nullopt: `value` is literal
  std::uint32_t value = 0;
};

struct Instruction {
  vm::Opcode opcode{};
  std::array<Operand, 3> operands;  // of a wide kind in B, C is empty
};

// The origin of code: a statement, or the rule of a condition.
struct Source {
  std::uint16_t line = 0;
  Span span;
};

// The first instruction from a source line.
struct Mark {
  std::size_t at = 0;  // counts from the start of the object
  Source source;
};

// A condition or a response.
class CodeDraft {
public:
  // Returns the index of the instruction.
  std::size_t emit(vm::Opcode opcode, Operand a = {}, Operand b = {}, Operand c = {}) {
    instructions_.push_back({opcode, {a, b, c}});
    return instructions_.size() - 1;
  }
  // Instructions emitted from now on come from `source`.
  void mark(const Source& source);
  [[nodiscard]] Source source() const { return marks_.empty() ? Source{} : marks_.back().source; }
  // Makes the forward jump at `from` go to the next instruction that is emitted. Jumps in the code that it skips must have
  // landed, unless they go further. A jump that compares becomes two instructions if its target is out of reach.
  void land(std::size_t from);
  // Makes the last instruction put its result into `cell`.
  void retarget(Cell cell) { instructions_.back().operands[0] = cell; }
  // Turns the last instruction, a command, into the end of the response.
  void end_with_command() { instructions_.back().opcode = vm::Opcode::cmd_end; }
  // The operand of a jump back to `target`, in the instruction that is emitted next.
  [[nodiscard]] Operand back_to(std::size_t target) const { return distance(target, size() + 1); }

  [[nodiscard]] std::size_t size() const { return instructions_.size(); }
  [[nodiscard]] const std::vector<Instruction>& instructions() const { return instructions_; }
  [[nodiscard]] const std::vector<Mark>& marks() const { return marks_; }

private:
  static Operand distance(std::size_t from, std::size_t to) {
    return static_cast<std::uint32_t>(to - from);
  }

  void split(std::size_t from);

  std::vector<Instruction> instructions_;
  std::vector<Mark> marks_;
};

// ---- frames
//
// The frame of one behaviour: the cells that its code uses, and their places.
//
// inputs that it sets | its other inputs | locals | truths of its watch rules | registers

// A condition or response: its words, and the words where source lines begin.
struct CodeObject {
  std::vector<vm::Word> words;
  std::vector<Mark> marks;
};

class Frame {
public:
  // While code is emitted: each call requests such a cell.
  Cell read(std::uint32_t input);
  Cell write(std::uint32_t input);
  Cell add_local();  // a new one; locals are never shared between responses
  Cell add_watch();
  Cell temporary(std::uint32_t depth);

  // After all code has been emitted.
  [[nodiscard]] std::vector<std::uint32_t> inputs() const;  // in the order of their cells
  [[nodiscard]] std::size_t writable() const { return written_.size(); }
  [[nodiscard]] std::uint32_t locals() const { return locals_; }
  // The size of the whole frame. It does not fit if it is larger than vm::kMaxCells.
  [[nodiscard]] std::size_t cells() const;
  // Replaces every cell in `code` by its place. Only for a frame that fits.
  [[nodiscard]] CodeObject resolve(const CodeDraft& code) const;

private:
  std::set<std::uint32_t> read_, written_;  // numbers of inputs
  std::uint32_t locals_ = 0, watches_ = 0, temporaries_ = 0;
};

// ---- the code section
//
// The code and constant sections under construction. Equal constants and equal code objects are stored once. Objects with timers
// are never equal, because each use needs its own timer.

inline constexpr std::size_t kMaxConst8 = 256;  // constants that a one-byte operand reaches

class CodePool {
public:
  [[nodiscard]] std::size_t constant(vm::Value value);
  // The same for a one-byte operand; nullopt if the constant is out of its reach.
  [[nodiscard]] std::optional<std::uint32_t> near_constant(vm::Value value);
  // Returns the object's offset in the code section.
  [[nodiscard]] std::size_t add(const CodeObject& object);

  [[nodiscard]] const std::vector<vm::Value>& constants() const { return constants_; }
  [[nodiscard]] const std::vector<vm::Word>& code() const { return code_; }
  [[nodiscard]] std::vector<vm::SourceLine> lines() const;
  // The source of a word of the code section; empty if it is not known.
  [[nodiscard]] Span span_of(std::size_t word) const;

private:
  std::map<vm::Value, std::size_t> constant_places_;
  std::map<std::vector<vm::Word>, std::size_t> object_places_;
  std::vector<vm::Value> constants_;
  std::vector<vm::Word> code_;
  std::vector<Mark> marks_;  // `at` counts from the start of the section
};

}  // namespace robosync::compiler
