// Selects the events of a run that a person wants to see.
#pragma once

#include <vector>

#include "link/events.hpp"
#include "vm/image.hpp"

namespace robosync::tool {

// Takes the events of a run in order. It leaves out readings and how the robot reached its
// decisions: rules that trigger, wait and end, priorities that adapt, commands that are done.
class Digest {
public:
  // `image` must outlive it.
  explicit Digest(const vm::Image& image)
      : image_(image), shown_(image.variables.size(), vm::kUnknown) {}

  [[nodiscard]] bool shows(const link::Event& event);

private:
  [[nodiscard]] bool shows_value(const link::Event& event);

  const vm::Image& image_;
  std::vector<vm::Value> shown_;  // the value of each variable that was shown last
};

}  // namespace robosync::tool
