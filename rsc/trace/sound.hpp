// Recordings of sound: what the robot's microphone hears of them.
#pragma once

#include <string>
#include <vector>

#include "runtime-m4/drivers/ear.hpp"

namespace robosync::tool {

// One for each 20 ms of the file, whatever its format (WAV, FLAC, Ogg …), rate and number of channels. Throws Failure (outside) when
// it cannot be read, and (program) when it is no sound, has less than the 8,000 samples a second of the ear, or lasts for more than
// an hour.
[[nodiscard]] std::vector<drivers::Heard> hear_file(const std::string& file);

}  // namespace robosync::tool
