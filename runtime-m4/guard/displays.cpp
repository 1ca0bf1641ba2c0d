// The displays of a program: see output_guard.hpp.
#include <cstdint>
#include <span>

#include "runtime-m4/guard/output_guard.hpp"

namespace robosync::guard {

// The image must be verified.
void OutputGuard::own_displays(const vm::Image& image) {
  for (unsigned a = 0; a < image.actuators.size() && display_count_ < displays_.size(); ++a) {
    const vm::Actuator& actuator = image.actuators[a];
    if (!vm::drives_screen(actuator.driver)) continue;
    slots_[a] = {};
    on_chips_ |= Mask{1} << a;
    displays_[display_count_++] = {.screen = {},
                                   .picture = 0,
                                   .sensor = actuator.bus,
                                   .actuator = static_cast<std::uint8_t>(a),
                                   .holds = actuator.safe == vm::Release::hold};
  }
}

std::uint32_t OutputGuard::picture_on(unsigned sensor) const {
  const auto lock = kernel_.lock();
  for (const Display& display : std::span(displays_).first(display_count_))
    if (display.sensor == sensor) return display.picture;
  return 0;
}

OutputGuard::Screen* OutputGuard::screen_of(unsigned sensor) {
  const auto lock = kernel_.lock();
  for (Display& display : std::span(displays_).first(display_count_))
    if (display.sensor == sensor) return &display.screen;
  return nullptr;
}

}  // namespace robosync::guard
