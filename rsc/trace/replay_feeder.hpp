// Feeds the readings of a recording to a simulated robot, each to the step that had it.
#pragma once

#include <cstdint>
#include <set>

#include "rsc/trace/replay_file.hpp"
#include "rsc/trace/replay_readings.hpp"
#include "runtime-m4/sim/simulator.hpp"
#include "vm/image.hpp"

namespace robosync::tool {

// Runs the robot until the last recorded event. `silent`: the channels that became silent.
void feed_readings(sim::Simulator& simulator, const RecordedProgram& recorded,
                   const vm::Image& image, const Readings& readings,
                   const std::set<std::uint8_t>& silent);

}  // namespace robosync::tool
