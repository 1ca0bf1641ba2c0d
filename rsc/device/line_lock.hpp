// Who uses a line that every rsc on this computer can open: one at a time, for two would each take bytes that are for the
// other. Who uses it for long lends it to those who want it.
#pragma once

#include <functional>
#include <string>

#include "rsc/device/transport.hpp"

namespace robosync::tool {

class LineLock {
public:
  // Of the open device `file`, until that is closed. in_turn waits a second for another rsc to lend the line, or to end; then
  // it throws Failure (outside). at_once only wants it.
  LineLock(int file, const std::string& port, Sharing sharing);

  // Does another one wait for the line?
  bool wanted() const;
  // Lets it go and waits until nobody has it or wants it. False when `waiting`, asked again and again, has given up: then
  // the line is the other one's.
  [[nodiscard]] bool lend(const std::function<bool()>& waiting) const;

private:
  int file_;
};

}  // namespace robosync::tool
