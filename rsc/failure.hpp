// How a verb ends when it does not end well: an exit code, and what is wrong in one message.
#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>

namespace robosync::tool {

enum class Exit : std::uint8_t {
  fine = 0,
  program = 1,  // the program, its configuration or a test is wrong
  usage = 2,
  outside = 3,  // a file or a device
};

class Failure : public std::runtime_error {
public:
  // An empty message: it has been said already.
  Failure(Exit exit, const std::string& message) : std::runtime_error(message), exit_(exit) {}
  Exit exit() const { return exit_; }

private:
  Exit exit_;
};

}  // namespace robosync::tool
