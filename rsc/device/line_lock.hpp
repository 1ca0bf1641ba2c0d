// Sharing::alone (transport.hpp), for devices.
#pragma once

#include <string>

namespace robosync::tool {

// Of the open device `file`, until it is closed. Waits half a second for one that is about to end; then throws Failure
// (outside).
void lock_line(int file, const std::string& port);

}  // namespace robosync::tool
