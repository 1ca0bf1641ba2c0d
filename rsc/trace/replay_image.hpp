// The recorded program as a replay runs it: with readings from outside only, and with the numbers that it began with.
#pragma once

#include <cstddef>
#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include "rsc/program.hpp"
#include "rsc/trace/replay_file.hpp"
#include "vm/image.hpp"

namespace robosync::tool {

// The program with all sensors fed, so that it needs neither drivers nor algorithms; but the encoders of a drive stay encoders, as
// it goes by them. A damaged image is returned unchanged.
[[nodiscard]] std::vector<std::byte> with_fed_sensors(std::vector<std::byte> bytes);

// Channels pass every reading unchanged, and only the `silent` ones can become stale.
[[nodiscard]] std::vector<std::byte> with_plain_channels(const Program& program,
                                                         const std::set<std::uint8_t>& silent);

// The program with the values that its variables began with in the recording. It may be another one, which lacks some.
[[nodiscard]] std::vector<std::byte> with_beginnings(std::vector<std::byte> bytes,
                                                     const RecordedProgram& recorded);

// The channels that the recorded program did not read. Empty if the recorded image is of another version of RoboSync, whose
// channels are not known.
[[nodiscard]] std::vector<std::string> unrecorded(const RecordedProgram& recorded,
                                                  const vm::Image& image);

}  // namespace robosync::tool
