// What of a run a person wants to see.
#pragma once

#include <vector>

#include "link/events.hpp"
#include "vm/image.hpp"

namespace robosync::tool {

// Takes the events of a run in their order. What is left out are readings, and how the robot came to
// what it does: rules that trigger, wait and end, priorities that adapt, commands that are done.
class Digest {
public:
  // `image` must outlive it.
  explicit Digest(const vm::Image& image)
      : image_(image), shown_(image.variables.size(), vm::kUnknown) {}

  [[nodiscard]] bool shows(const link::Event& event);

private:
  [[nodiscard]] bool shows_value(const link::Event& event);

  const vm::Image& image_;
  std::vector<vm::Value> shown_;  // of each variable, the value that was shown last
};

}  // namespace robosync::tool
