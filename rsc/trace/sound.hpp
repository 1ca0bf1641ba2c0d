// What the robot's microphone hears of a sound file.
#pragma once

#include <string>
#include <vector>

#include "runtime-m4/drivers/ear.hpp"

namespace robosync::tool {

// One for each 20 ms of the file, whatever its format (WAV, FLAC, Ogg …), rate and number of channels. Throws Failure (outside)
// if it cannot be read, and (program) if it is not a sound file, has less than the 8,000 samples a second of the ear, or is
// longer than an hour.
[[nodiscard]] std::vector<drivers::Heard> hear_file(const std::string& file);

}  // namespace robosync::tool
