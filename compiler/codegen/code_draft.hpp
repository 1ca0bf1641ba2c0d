// Instructions before the frame of their behaviour is laid out: an operand may be a cell that is
// known only by what it is for. Frame::resolve() turns them into words.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "compiler/source/source_file.hpp"
#include "vm/opcode.hpp"

namespace robosync::compiler {

// The parts of a frame, in their order.
enum class Zone : std::uint8_t { input, local, watch, temporary };

// A cell of the frame. `number`: of an input, the input's number in the image; else the place in
// its zone.
struct Cell {
  Zone zone = Zone::temporary;
  std::uint32_t number = 0;
};

struct Operand {
  Operand() = default;
  Operand(std::uint32_t a_value) : value(a_value) {}
  Operand(Cell cell) : zone(cell.zone), value(cell.number) {}

  std::optional<Zone> zone;  // nothing: `value` as it stands
  std::uint32_t value = 0;
};

struct Instruction {
  vm::Opcode opcode{};
  std::array<Operand, 3> operands;  // of a wide kind in B, C is empty
};

// Where code comes from: a statement, or the rule of a condition.
struct Source {
  std::uint16_t line = 0;
  Span span;
};

// The first instruction that comes from a line.
struct Mark {
  std::size_t at = 0;  // counts from the object's start
  Source source;
};

// A condition or a response.
class CodeDraft {
public:
  // Gives the place of the instruction.
  std::size_t emit(vm::Opcode opcode, Operand a = {}, Operand b = {}, Operand c = {}) {
    instructions_.push_back({opcode, {a, b, c}});
    return instructions_.size() - 1;
  }
  // What is emitted from now on comes from `source`.
  void mark(const Source& source);
  [[nodiscard]] Source source() const { return marks_.empty() ? Source{} : marks_.back().source; }
  // Makes the jump at `from`, whose target lies ahead, go to what is emitted next. All jumps
  // behind it that stay behind it must have landed. Where one that compares does not reach that
  // far, it becomes two instructions.
  void land(std::size_t from);
  // Makes the last instruction put its result into `cell`.
  void retarget(Cell cell) { instructions_.back().operands[0] = cell; }
  // Makes the last instruction, a command, the end of the response.
  void end_with_command() { instructions_.back().opcode = vm::Opcode::cmd_end; }
  // The operand of an instruction emitted next that goes back to `target`.
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

}  // namespace robosync::compiler
