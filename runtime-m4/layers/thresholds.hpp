// Which readings make a difference to rules.
//
// Most rules compare a channel with constants and use it for nothing else that could make them act. While the readings of such a
// channel stay between two of these constants, all conditions keep their results, so a step need not evaluate them
// (ProcessingLayer::find_concerned()). What qualifies is worked out from the rules' code when a program is loaded. SAFETY rules do
// not count: the safety thread evaluates them at every reading.
#pragma once

#include <cstdint>
#include <span>

#include "runtime-m4/layers/memory.hpp"
#include "runtime-m4/layers/messages.hpp"
#include "vm/image.hpp"

namespace robosync::layers {

class Thresholds {
public:
  // `image` is verified, and `memory` is laid out for it.
  void start(const vm::Image& image, Memory& memory);

  // False: no rule can tell these two readings of the channel apart. Unknown differs from every number.
  [[nodiscard]] bool separate(unsigned channel, vm::Value from, vm::Value to) const;

private:
  // The constants of a channel: a part of `compared_`.
  struct Run {
    static constexpr std::uint16_t kAny = 0xFFFF;  // as `first`: any two readings differ

    std::uint16_t first;
    std::uint16_t end;
  };

  void insert(Run& run, std::uint8_t constant);

  const vm::Value* constants_ = nullptr;  // of the image
  std::uint8_t* compared_ =
      nullptr;           // indices of constants, in each run by value, without repetitions
  std::span<Run> runs_;  // by channel
};

}  // namespace robosync::layers
