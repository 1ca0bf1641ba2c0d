// Sound as the frames that own_words hears: the spectrum of each 20 ms, as a robot's microphone gives it.
#pragma once

#include <array>
#include <memory>
#include <string>

#include "companion/sound_source.hpp"
#include "runtime-m4/algorithms/own_words.h"
#include "runtime-m4/drivers/spectrum.hpp"

namespace robosync::companion {

constexpr long kFrameMs = 20;

class Hearing {
public:
  // As open_sound().
  Hearing(const std::string& source, bool no_pace) : source_(open_sound(source, no_pace)) {}

  // The next 20 ms. False: the sound is over, and the frame is of silence or ends with it.
  bool next(own_words_frame& frame);

private:
  static constexpr std::size_t kBlock = 160;

  std::unique_ptr<SoundSource> source_;
  std::array<std::int16_t, drivers::kSpectrumWindow + 1> past_{};
};

}  // namespace robosync::companion
