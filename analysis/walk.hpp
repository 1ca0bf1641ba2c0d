// One pass over a code object. Before each word it knows what the cells of the frame may hold, whichever
// way the word is reached, and how long the response has waited at least. Images must be verified: blocks
// nest, jumps go forward or around loops (vm/verify_blocks.hpp).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "analysis/interval.hpp"

namespace robosync::analysis {

using Ranges = std::array<Interval, std::size_t{2} * vm::kMaxInputs>;  // of inputs, by number

// How long a pause takes at least: a WAIT takes as long as its number, and at least until the next step; any other one takes
// policy::kLeastPauseMs.
[[nodiscard]] std::uint32_t least_wait_ms(vm::Word word, std::span<const Interval> cells);
// Does it write a number or a truth into its cell A?
[[nodiscard]] bool writes(vm::Word word);

class Walk {
public:
  Walk(const vm::Image& image, const vm::Behavior& behavior, std::span<const vm::Word> code,
       const Ranges& inputs);

  // Goes to the next word; false: there is none.
  bool next();
  // … and the state before it runs.
  [[nodiscard]] std::size_t at() const { return at_; }
  [[nodiscard]] vm::Word word() const { return code_[at_]; }
  [[nodiscard]] std::span<const Interval> cells() const { return now_.cells; }
  [[nodiscard]] std::uint64_t waited_ms() const { return now_.waited_ms; }
  void run();

private:
  struct State {
    void join(const State& other);
    std::array<Interval, vm::kMaxCells + 1> cells;
    std::uint64_t waited_ms = 0;
  };
  // The state at the target of a jump; at 0: no target.
  struct Coming {
    std::size_t at = 0;
    State state;
  };
  Coming& coming_to(std::size_t at);
  void latch(bool also_as_it_was);
  void jump(std::size_t words_ahead);
  void begin_loop();

  const vm::Image& image_;
  std::span<const vm::Word> code_;
  std::span<const std::uint8_t> numbers_;  // of the behaviour's inputs
  const Ranges& inputs_;
  std::size_t at_ = static_cast<std::size_t>(-1);
  State now_;
  bool reached_ = true;                            // from the previous word
  std::array<Coming, vm::kMaxBlocks + 2> coming_;  // one for each open IF, and the ELSE to come
};

}  // namespace robosync::analysis
