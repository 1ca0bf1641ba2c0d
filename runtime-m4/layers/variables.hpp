// What a program remembers: REMEMBER, STATE, FEELING, SIGNAL. The values that rules see are in the
// snapshot; this class computes their values for the next step.
//
// Writes of a step are staged and take effect together when the next step begins, as if done from
// the least important behaviour up to the most important one: of two SETs the more important one wins, and
// RAISE and LOWER add to the value so far. Responses run, and so stage their writes, in the opposite
// order. So one sum per variable is enough: the first SET that is staged ends it. The result is
// clamped to the variable's range once, at the end.
//
// A fading variable is its target plus a part of the distance that it had when it was last set;
// that part depends only on how many whole ticks ago that was.
#pragma once

#include <cstdint>
#include <span>

#include "runtime-m4/kernel/kernel.hpp"
#include "runtime-m4/layers/carried.hpp"
#include "runtime-m4/layers/memory.hpp"
#include "runtime-m4/layers/messages.hpp"
#include "vm/interpreter.hpp"

namespace robosync::layers {

class Variables {
public:
  struct Write {
    std::uint8_t variable;  // index among the variables
    bool set;               // value is the new value; otherwise a difference
    vm::Value value;        // if unknown, there is no such write
  };

  // What a response has written into its behaviour's frame; in the masks bit c is cell c.
  struct Written {
    const vm::Value* frame;
    std::uint32_t assigned;  // by SET
    std::uint32_t shifted;   // by RAISE and LOWER
  };

  explicit Variables(kernel::Kernel& kernel) : kernel_(kernel) {}

  // Writes the initial values into `values`, one for each variable of `image`.
  void start(const vm::Image& image, std::span<vm::Value> values, const Beginnings& beginnings,
             Memory& memory);

  // Stages what a response of `behavior` has written; its frame was latched from `before`. In each step, call it from the most
  // important response down.  [step thread]
  void stage(const Written& written, const vm::Behavior& behavior, const Snapshot& before);
  // … as more important than all of those, at any time.  [safety thread]
  void stage_first(const Written& written, const vm::Behavior& behavior, const Snapshot& before);

  // --- for the step thread; `now` is milliseconds of program time ---
  bool staged() const { return staged_ != 0; }
  // False: enter() has nothing to do and may be left out.
  bool may_change() const { return (staged_ | fading_) != 0; }
  // Advances `values` to `now` and applies the staged writes. Returns what changed.
  VariableMask enter(std::uint32_t now, std::span<vm::Value> values);
  // In how many milliseconds the next one fades; kNever if all have reached their target.
  std::uint32_t next_fade(std::uint32_t now, std::span<const vm::Value> values) const;

private:
  struct Fade {
    vm::Value from = 0;       // its value when it was last set
    std::uint32_t since = 0;  // when that was
  };

  enum class Rank : std::uint8_t { below_those_staged, above_all };
  template <Rank rank>
  void stage_all(const Written& written, const vm::Behavior& behavior, const Snapshot& before);
  // What is set becomes the new value; otherwise it is a difference.
  template <Rank rank>
  void stage_one(unsigned variable, bool set, vm::Value value);
  bool take(unsigned variable, Write& write);
  static vm::Value result_of(const vm::Variable& wiring, vm::Value before, const Write& write);

  kernel::Kernel& kernel_;
  const vm::Image* image_ = nullptr;
  std::uint32_t entered_ = 0;  // when enter() was called last
  VariableMask fading_ = 0;
  VariableMask staged_ = 0;
  VariableMask set_ = 0;  // those of staged_ whose sum ends with a SET
  std::span<vm::Value> sums_;
  std::span<Fade> fades_;  // one per fading variable, in order
};

// What is left of `distance` after `ticks` times kFadeTickMs, each of which leaves fade / 2^31 of it:
// rounded towards zero, so that it ends.
[[nodiscard]] std::int64_t faded(std::int64_t distance, std::uint32_t fade, std::uint32_t ticks);

}  // namespace robosync::layers
