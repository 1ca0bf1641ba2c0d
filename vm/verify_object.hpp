// Verifier, part: one code object, as a behaviour runs it. Assumes that the records are valid.
#pragma once

#include <array>

#include "vm/cost.hpp"
#include "vm/verification.hpp"

namespace robosync::vm {

// What is known about the cells of a behaviour's frame before an instruction, on every path to it.
class Cells {
public:
  explicit Cells(const Behavior& behavior, std::size_t watches)
      : inputs_(behavior.input_count),
        locals_end_(inputs_ + behavior.locals),
        first_register_(static_cast<unsigned>(locals_end_ + watches)),
        count_(behavior.cells) {}

  // Another object begins: all locals up to the last one written are taken.
  void begin_object() {
    taken_end_ = written_end_;
    forget_registers();
  }
  void forget_registers() {
    for (unsigned word = 0; word <= count_ / 32; ++word)
      known_[word] = 0;
  }

  [[nodiscard]] bool is_input(std::uint8_t cell) const { return cell < inputs_; }
  [[nodiscard]] bool is_local(std::uint8_t cell) const {
    return cell >= inputs_ && cell < locals_end_;
  }
  [[nodiscard]] bool is_register(std::uint8_t cell) const {
    return cell >= first_register_ && cell < count_;
  }
  [[nodiscard]] bool in_frame(std::uint8_t cell) const { return cell < count_; }
  [[nodiscard]] bool is_set(std::uint8_t cell) const {
    return cell < first_register_ || has(known_, cell);
  }
  [[nodiscard]] bool is_truth(std::uint8_t cell) const {
    return cell >= locals_end_ && (cell < first_register_ || has(truths_, cell));
  }
  // A local that an object before this one may write.
  [[nodiscard]] bool is_taken(std::uint8_t cell) const { return cell < taken_end_; }

  void set(std::uint8_t cell, bool truth) {
    const std::uint32_t bit = std::uint32_t{1} << cell % 32;
    known_[cell / 32] |= bit;
    truths_[cell / 32] = truth ? truths_[cell / 32] | bit : truths_[cell / 32] & ~bit;
    if (is_local(cell) && cell >= written_end_) written_end_ = cell + 1U;
  }

private:
  using Bits = std::array<std::uint32_t, (kMaxCells + 31) / 32>;
  static bool has(const Bits& bits, std::uint8_t cell) {
    return (bits[cell / 32] >> cell % 32 & 1) != 0;
  }

  unsigned inputs_, locals_end_, first_register_, count_;
  unsigned written_end_ = 0;  // one past the last local that the objects so far write
  unsigned taken_end_ = 0;    // written_end_ when this object began
  Bits known_;   // registers that are set; begin_object() initializes the bits of existing cells
  Bits truths_;  // valid for registers that are set
};

struct CodeRange {
  std::uint16_t start;
  std::uint16_t length;
};

enum class ObjectKind : std::uint8_t { condition, period, response, safety };

// A behaviour and its frame, which its rules share. Rules are checked in order, each with its responses
// before its condition: what an object may do depends on the objects before it.
struct Frame {
  Frame(Verification& all, const Behavior& of)
      : verification(all), behavior(of), cells(of, count_watches(all.image, of)) {}

  Verification& verification;
  const Behavior& behavior;
  Cells cells;
  std::uint32_t actuators = 0;  // every actuator that a rule so far commands or halts
};

// For an accepted object, returns its highest cost between two waits, in M4 instructions, and every
// actuator that it commands or halts.
bool check_object(Frame& frame, ObjectKind kind, CodeRange range, std::uint32_t& cost,
                  std::uint32_t& actuators);

// verifier.cpp: all objects of a rule.
bool check_rule(Frame& frame, const Rule& rule, RuleCost& cost);

}  // namespace robosync::vm
