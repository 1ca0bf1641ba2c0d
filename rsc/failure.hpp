// How a verb fails: an exit code and one message that says what is wrong.
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
  // An empty message: the reason has been printed already.
  Failure(Exit exit, const std::string& message) : std::runtime_error(message), exit_(exit) {}
  Exit exit() const { return exit_; }

private:
  Exit exit_;
};

// The robot on the line has answered, and refuses. Repeating it is of no use; the line is in order.
class Refused : public Failure {
public:
  explicit Refused(const std::string& message) : Failure(Exit::outside, message) {}
};

// The message with one more sentence.
[[nodiscard]] inline std::string followed_by(const std::string& message,
                                             const std::string& sentence) {
  const bool ends = message.ends_with('?') || message.ends_with('.');
  return message + (ends ? " " : ". ") + sentence;
}

}  // namespace robosync::tool
