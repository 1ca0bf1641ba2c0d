// What a program really did in a simulated run, as the steps of a block (firmware/block.hpp).
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "rsc/program.hpp"

namespace robosync::timing {

// Runs the program in the simulator with a scenario. Throws tool::Failure.
[[nodiscard]] std::vector<std::uint32_t> script_of(const tool::Program& program,
                                                   const std::string& scenario);

}  // namespace robosync::timing
