// External programs that flash a board.
#pragma once

#include <string>
#include <vector>

namespace robosync::tool {

// Is a program of this name on PATH?
[[nodiscard]] bool is_installed(const std::string& program);

// Runs it without a shell; it inherits rsc's stdout and stderr. Returns its exit code; 127 if it could not
// be started, 128 and more if a signal ended it.
[[nodiscard]] int run_program(const std::vector<std::string>& command);

}  // namespace robosync::tool
