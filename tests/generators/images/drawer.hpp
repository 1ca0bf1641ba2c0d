// Draws operands and instructions that are likely to be right at a place in a code object.
//
// It keeps what the words before have left in the registers, roughly as the verifier does; but
// nothing here decides what is right: now and then an operand is drawn from all there are.
#pragma once

#include <bitset>

#include "tests/generators/images/draft.hpp"
#include "tests/support/operands.hpp"

namespace robosync::fuzz {

class Drawer {
public:
  // Before the object's first word. The draft must not be changed meanwhile.
  Drawer(const Draft& draft, const Object& object, Random& random);

  // One in `odds` operands is any byte; 0: none.
  void set_odds(std::uint32_t odds) { odds_ = odds; }
  // The word is what stands there: what it leaves in the registers is known from now on.
  void learn(Word word);
  void forget();

  // An instruction that is no flow, ends nothing and takes no parameters.
  [[nodiscard]] Word plain();
  // With operands for every place but distances.
  [[nodiscard]] Word instruction(Opcode opcode);
  // For one place, which is none for distances; the word's other operands are given.
  [[nodiscard]] unsigned draw(Word word, std::size_t place);
  // A register that holds a truth value, or what comes near it.
  [[nodiscard]] unsigned truth();
  [[nodiscard]] std::size_t locals() const { return locals_end_ - inputs_; }
  [[nodiscard]] unsigned local();
  [[nodiscard]] Opcode opcode_with(bool (*wanted)(Opcode));
  [[nodiscard]] vm::Context context() const { return context_; }

private:
  using Cells = std::bitset<256>;

  [[nodiscard]] unsigned draw_kind(Word word, std::size_t place);
  [[nodiscard]] unsigned cell(const Cells& among, bool with_inputs);
  [[nodiscard]] unsigned written();
  [[nodiscard]] unsigned variable();
  [[nodiscard]] unsigned count();
  [[nodiscard]] unsigned timer(Opcode opcode);
  [[nodiscard]] unsigned target(Opcode opcode);
  [[nodiscard]] unsigned verb(unsigned target);
  [[nodiscard]] unsigned entry(unsigned verb);

  const vm::Image& image_;
  vm::Context context_;
  Random& random_;
  std::uint32_t odds_ = 64;
  std::size_t inputs_ = 0, first_input_ = 0, locals_end_ = 0, first_register_ = 0, cells_ = 0;
  std::size_t next_timer_ = 0;
  std::uint32_t owned_ = 0;
  Cells known_, truths_;  // of the registers
};

}  // namespace robosync::fuzz
