// One channel of a sensor: robot.json's or a device descriptor's "channels" entry.
#pragma once

#include "compiler/config/json_reader.hpp"
#include "compiler/config/robot.hpp"

namespace robosync::compiler {

// Overwrites in `channel` what `value` says; the rest stays as the device's descriptor has it.
// `inputs`: how many inputs the device has.
void read_channel(const json::Value& value, unsigned inputs, ChannelConfig& channel,
                  Diagnostics& diagnostics);

}  // namespace robosync::compiler
