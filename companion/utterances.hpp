// Detects utterances: from the first loud frame to the last one before a pause. A frame is loud if it is above the background
// noise, which is the level of the softest fifth of the last three seconds, in each band.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "companion/words_file.hpp"

namespace robosync::companion {

struct Utterance {
  Sample levels;   // in half decibels above the softest
  Levels noise{};  // the background noise before it began
};

class Utterances {
public:
  Utterances();

  // Only learns the background noise from the frame. For the beginning of a recording.
  void learn(const Levels& levels);
  // True: an utterance ended with this frame; it is in last(). Utterances shorter or longer than a word can be are ignored.
  [[nodiscard]] bool hear(const Levels& levels);
  [[nodiscard]] const Utterance& last() const { return utterance_; }
  // The last utterance was ignored because it was too long.
  [[nodiscard]] bool was_too_long() const { return was_too_long_; }

private:
  static constexpr std::size_t kMemory = 192;  // frames: 3 s
  static constexpr std::size_t kSmooth = 4;    // frames whose power is averaged
  static constexpr std::size_t kPause = 18;    // frames that are not loud end an utterance: 288 ms
  static constexpr std::size_t kBefore = 3;    // frames before the first loud one that belong to it

  [[nodiscard]] const Levels& ago(std::size_t frames) const;
  void remember(const Levels& levels);
  void look_at_noise();
  [[nodiscard]] bool is_loud() const;
  void begin();
  [[nodiscard]] bool end();

  std::array<Levels, kMemory> frames_{}, smooth_{};
  std::size_t count_ = 0;  // frames heard
  Levels noise_{};
  std::array<double, 256> powers_{};  // for each level
  Utterance utterance_;
  bool talks_ = false, was_too_long_ = false;
  std::size_t loud_in_a_row_ = 0, length_ = 0, loud_until_ = 0;
};

}  // namespace robosync::companion
