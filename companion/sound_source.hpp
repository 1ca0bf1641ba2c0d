// Sound, 16,000 samples a second, of one channel: from a file (WAV, FLAC, Ogg) or a microphone.
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

  // Fills `samples`, and waits for that; fewer: it is over. Throws Failure (outside) when the microphone fails.
  virtual std::size_t read(std::span<std::int16_t> samples) = 0;
};

// A file when there is one called `name`, else the microphone that ALSA calls so. Throws Failure (outside).
[[nodiscard]] std::unique_ptr<SoundSource> open_sound(const std::string& name, bool no_pace);

}  // namespace robosync::companion
