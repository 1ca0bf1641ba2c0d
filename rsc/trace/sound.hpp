// What the robot's microphone hears of a sound file.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "runtime-m4/drivers/ear.hpp"

namespace robosync::tool {

// The values of a microphone's channels for 20 ms of sound (stdlib/devices/microphone.json, in order).
inline constexpr std::array kSoundChannels = {"LOUDNESS", "HIGHS",   "PITCH",   "CLARITY",
                                              "BANDS_1",  "BANDS_2", "BANDS_3", "BANDS_4"};
using SoundBlock = std::array<vm::Value, kSoundChannels.size()>;

// One for each 20 ms of the file, whatever its format (WAV, FLAC, Ogg …), rate and number of channels. Throws Failure (outside)
// if it cannot be read, and (program) if it is not a sound file, has less than the 8,000 samples a second of the ear, or is
// longer than an hour.
[[nodiscard]] std::vector<SoundBlock> hear_file(const std::string& file);

}  // namespace robosync::tool
