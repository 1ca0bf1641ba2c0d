// Sound, 16,000 samples a second, one channel, from a file (WAV, FLAC, Ogg) or a microphone.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>

namespace robosync::companion {

constexpr int kSoundRate = 16'000;

class SoundSource {
public:
  SoundSource() = default;
  virtual ~SoundSource() = default;
  SoundSource(const SoundSource&) = delete;
  SoundSource& operator=(const SoundSource&) = delete;

  // Waits until `samples` is full. Fewer samples: the sound is over. Throws Failure (outside) if the microphone fails.
  virtual std::size_t read(std::span<std::int16_t> samples) = 0;
};

// Opens the file `name` if there is one, otherwise the microphone with that ALSA name. Throws Failure (outside).
[[nodiscard]] std::unique_ptr<SoundSource> open_sound(const std::string& name, bool no_pace);

}  // namespace robosync::companion
