// What a microphone's driver makes of sound: four numbers for each 20 ms, and the spectrum for modules that recognise words. The
// sound itself goes no further: a block of it is larger than all the memory of most modules, and three times what the link carries.
// Integers only, so the result is the same everywhere: rsc hears recordings with it.
//
// Pitch is found by autocorrelation: the lag after which the sound repeats. Low pitches are searched in means of two
// samples, which is a quarter of the work; high ones in all samples. For a single tone the result is accurate to 1 %.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "runtime-m4/drivers/spectrum.hpp"
#include "vm/value.hpp"

namespace robosync::drivers {

inline constexpr unsigned kEarRate = 8000;  // samples a second, of 16 bits
inline constexpr std::size_t kEarBlock = 160;
inline constexpr unsigned kEarPeriodMs = 20;

// In the order of the microphone's channels (stdlib/devices/microphone.json).
struct Heard {
  vm::Value loudness = 0;  // dB; 0 is one step of a sample, 90 is the loudest
  vm::Value highs = 0;     // … of the differences between samples, where high sounds are louder
  vm::Value pitch = 0;     // Hz, 80 to 2,000, in tenths; 0: no pitch
  vm::Value clarity = 0;   // %, how far the sound repeats itself at that pitch
};

class Ear {
public:
  // Each in whole units, the pitch in tenths.
  [[nodiscard]] Heard hear(std::span<const std::int16_t, kEarBlock> block);

  // The same in two parts, for a block that is written where it is heard: it is to be filled, or forgotten.
  [[nodiscard]] std::span<std::int16_t, kEarBlock> next();
  [[nodiscard]] Heard hear_next();
  // The spectrum of the latest block, and of more than half of the one before.
  [[nodiscard]] BandValues bands() {
    return bands_of(std::span(past_).last<kSpectrumWindow + 1>(),
                    std::span(work_).first<kSpectrumWindow>());
  }
  // Samples were lost: the next block follows on silence.
  void forget();

private:
  // Two blocks: a deep voice repeats after 12 ms, and must do so twice.
  static constexpr std::size_t kPast = 2 * kEarBlock;
  // A lag at which a sound is more like itself than at the lags next to it.
  struct Peak {
    std::int32_t lag = 0;  // in samples, times kPart
    std::int32_t height = 0;
  };
  struct Peaks;
  void find_pitch(Heard& heard);

  std::array<std::int16_t, kPast> past_{};
  std::int16_t last_ = 0;
  bool follows_ = true;  // the next block on the last one
  // Larger than a sensor's stack.
  std::array<std::int16_t, kPast> work_;
  std::array<Peak, 32> peaks_;  // two adjacent lags are never both peaks
};

}  // namespace robosync::drivers
