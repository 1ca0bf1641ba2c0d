// Verifier, part: how the blocks of a code object nest, and the cost and output of a run.
//
// One pass, without going back: jumps go only to the ends of blocks and the starts of loops, so the
// cost of the costliest path to an instruction is known when the pass reaches it. A wait ends a run,
// and the count starts again. A loop either runs a constant number of times, and its body counts that
// many times; or it waits in every round, and a run covers at most the code after its last wait and,
// around the loop's end, the code before its first one. A wait that can be skipped inside a loop does
// not count as a wait.
//
// The variables that the response owns are tracked in the same way: `set` makes it own one, a block
// ends with those that it began with, and a wait ends all ownership. If a loop changes a variable that
// it began with, it must not wait: the next round would not own the variable.
#pragma once

#include <array>

#include "vm/opcode_traits.hpp"
#include "vm/verification.hpp"

namespace robosync::vm {

// No cost may exceed this, so that the sum of a few costs fits 32 bits.
inline constexpr std::uint32_t kMaxCost = 1U << 29;

class Blocks {
public:
  // For the object that ends with the word at `last`.
  Blocks(const Image& image, std::size_t last) : image_(image), last_(last) {}

  // Does a block end before the word at `at`?
  [[nodiscard]] bool ends_at(std::size_t at) const {
    return depth_ > 0 && open_[depth_ - 1].end <= at;
  }
  // Ends the blocks that end before the word at `at`.
  [[nodiscard]] Refusal arrive(std::size_t at);
  // Counts the cost and the output of a word with valid operands.
  [[nodiscard]] Refusal spend(std::uint32_t cost, std::uint32_t output) {
    spent_.cost += cost;
    spent_.output += output;
    if (spent_.output > kMaxResponseOutput) return Refusal::too_much_output;
    return spent_.cost > kMaxCost ? Refusal::too_costly : Refusal::none;
  }
  // Call this after spend() for a word that begins or ends a block, or waits.
  [[nodiscard]] Refusal flow(std::size_t at, Word word, Traits traits);

  // The response owns this input from here on.
  void own(std::uint8_t input) { owned_ |= bit_of(input); }
  // May this input be changed in place? If so, notes the change.
  [[nodiscard]] bool change(std::uint8_t input);

  // Is it the cell of an open loop?
  [[nodiscard]] bool is_counter(std::uint8_t cell) const;
  // The cost of the costliest run.
  [[nodiscard]] std::uint32_t worst() const;

private:
  struct Spent {
    std::uint32_t cost = 0;
    std::uint32_t output = 0;
  };
  enum class Pauses : std::uint8_t {  // of a loop
    unknown,
    never,  // it changes a variable that it began with
    always  // in every round
  };
  struct Block {
    [[nodiscard]] bool is_loop() const { return closed_by != Flow::if_else; }

    std::uint32_t cost;  // IF: most spent at a jump to its end; loop: spent at its start. Its lead
                         // goes from there to the first wait
    union {
      std::uint32_t lead_cost;  // of a loop that always pauses
      std::uint32_t owned;      // at its begin, without those lost by a wait since
    };
    std::uint16_t start;  // loop: target of its jump back
    std::uint16_t end;    // IF: its end; loop: the latest place for its end
    std::uint8_t output, lead_output;
    Pauses pauses;
    Flow closed_by;  // the kind of word that may end it: the loop's own, or ELSE
  };
  static_assert(sizeof(Block) == 16, "stands kMaxBlocks times on a small stack");

  static constexpr std::uint32_t bit_of(std::uint8_t input) {
    return input < kMaxWritable ? std::uint32_t{1} << input : 0;
  }
  Block& top() { return open_[depth_ - 1]; }
  [[nodiscard]] std::size_t limit() const { return depth_ > 0 ? open_[depth_ - 1].end : last_; }
  [[nodiscard]] Word opener(const Block& loop) const { return image_.code[loop.start - 1U]; }

  Refusal open(Flow closed_by, std::size_t start, std::size_t end);
  Refusal begin_else(std::size_t next, std::size_t target);
  Refusal close_loop(std::size_t target, Word word, Flow end);
  Refusal repeat(const Block& loop);
  [[nodiscard]] bool disown();
  void wait();
  void take_worse(Block& block) const;

  const Image& image_;
  std::size_t last_;
  Spent spent_;  // since the last wait, on the costliest path
  std::uint32_t worst_ = 0;
  std::uint32_t owned_ = 0;  // bit i: input i
  unsigned depth_ = 0;
  std::array<Block, kMaxBlocks> open_;  // initialized: the first depth_
};

}  // namespace robosync::vm
