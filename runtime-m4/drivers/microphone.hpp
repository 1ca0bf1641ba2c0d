// The microphone of the board: every 20 ms the board hands over a block of sound, and the channels are what the ear hears in it,
// or its spectrum; only what a program has channels for is computed. It has state, so the sampler keeps it.
#pragma once

#include "runtime-m4/boards/board.hpp"
#include "runtime-m4/drivers/ear.hpp"
#include "vm/image.hpp"

namespace robosync::drivers {

class Microphone {
public:
  // A sample of one channel, in thousandths of its unit, as rsc has it from a recording. All channels are those of the block
  // that the first one takes. False if the board has no block.  [sensor's thread]
  bool sample(boards::Board& board, bool is_first, const vm::Channel& channel, vm::Value& value);

private:
  [[nodiscard]] vm::Value part(unsigned input);

  Ear ear_;
  Heard heard_;
  BandValues bands_{};
  bool hears_ = false, has_heard_ = false, has_bands_ = false;
};

}  // namespace robosync::drivers
