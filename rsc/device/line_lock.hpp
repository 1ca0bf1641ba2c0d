// Locks a line that every rsc on this computer can open: two at a time would each take bytes meant for the other. A
// long-running rsc lends the line to those that want it.
#pragma once

#include <functional>
#include <string>

#include "rsc/device/transport.hpp"

namespace robosync::tool {

class LineLock {
public:
  // Locks the open device `file` until it is closed. in_turn waits a second for another rsc to lend the line or to end, then
  // throws Failure (outside). at_once only requests it.
  LineLock(int file, const std::string& port, Sharing sharing);

  // Is another rsc waiting for the line?
  bool wanted() const;
  // Releases the line and waits until no other rsc has or wants it. False if `waiting`, which is polled, gave up: the other
  // rsc then has the line.
  [[nodiscard]] bool lend(const std::function<bool()>& waiting) const;

private:
  int file_;
};

}  // namespace robosync::tool
