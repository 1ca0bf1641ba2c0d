// When somebody says something, and what: from the first loud frame to the last one, with the pause behind it. Loud is what is
// above what is always there, which is the fifth of the last three seconds that was softest, band by band.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "companion/words_file.hpp"

namespace robosync::companion {

struct Utterance {
  Sample levels;   // in halves of a decibel above the softest
  Levels noise{};  // what was there before it began
};

class Utterances {
public:
  Utterances();

  // What is always there is learned from it; nobody is listened to. For the begin of a recording.
  void learn(const Levels& levels);
  // True: with this frame, something that was said is over, and is last(). What is shorter or longer than a word can be is not.
  [[nodiscard]] bool hear(const Levels& levels);
  [[nodiscard]] const Utterance& last() const { return utterance_; }
  // Of what was said last and was no word: it was too long.
  [[nodiscard]] bool was_too_long() const { return was_too_long_; }

private:
  static constexpr std::size_t kMemory = 192;  // frames: 3 s
  static constexpr std::size_t kSmooth = 4;    // frames whose power is taken together
  static constexpr std::size_t kPause =
      18;  // frames without anything loud, which end an utterance: 288 ms
  static constexpr std::size_t kBefore = 3;  // frames that belong to it before it is loud

  [[nodiscard]] const Levels& ago(std::size_t frames) const;
  void remember(const Levels& levels);
  void look_at_noise();
  [[nodiscard]] bool is_loud() const;
  void begin();
  [[nodiscard]] bool end();

  std::array<Levels, kMemory> frames_{}, smooth_{};
  std::size_t count_ = 0;  // frames heard
  Levels noise_{};
  std::array<double, 256> powers_{};  // of a level
  Utterance utterance_;
  bool talks_ = false, was_too_long_ = false;
  std::size_t loud_in_a_row_ = 0, length_ = 0, loud_until_ = 0;
};

}  // namespace robosync::companion
