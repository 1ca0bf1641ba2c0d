// One rsc at a time on a line: two would each take bytes that are for the other.
#pragma once

#include <string>

namespace robosync::tool {

// Of the open device `file`, until it is closed. Waits half a second for one that is about to end; then throws Failure
// (outside).
void lock_line(int file, const std::string& port);

}  // namespace robosync::tool
