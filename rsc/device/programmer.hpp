// Programs of others that put a firmware on a board.
#pragma once

#include <string>
#include <vector>

namespace robosync::tool {

// Is a program of this name on PATH?
[[nodiscard]] bool is_installed(const std::string& program);

// Runs it, without a shell; what it says goes where rsc's own words go. Returns its exit code; 127 when it
// could not be started, 128 and more when a signal ended it.
[[nodiscard]] int run_program(const std::vector<std::string>& command);

}  // namespace robosync::tool
