// How a host introduces itself to a board: the computer's name, for people, and behind it which computer and which process it is,
// so that the same computer can tell whether that process still exists. Names of computers are not unique.
#pragma once

#include <string>

#include <sys/types.h>

#include "link/messages.hpp"

namespace robosync::tool {

// The computer's name, shortened, and `process` of this computer.
[[nodiscard]] link::Name host_name(pid_t process);
// Only the computer's name.
[[nodiscard]] std::string host_text(const link::Name& host);
// Was that a process of this computer that does not exist any more, or this process? If in doubt, no.
[[nodiscard]] bool is_gone(const link::Name& host);

}  // namespace robosync::tool
