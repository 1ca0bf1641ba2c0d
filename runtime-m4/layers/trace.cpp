// See trace.hpp.
#include "runtime-m4/layers/trace.hpp"

#include <algorithm>

namespace robosync::layers {

kernel::Time Trace::time_after(std::uint32_t now, std::uint32_t delay) const {
  const auto still = kernel_.lock();
  const std::uint32_t passed = std::min(milliseconds() - now, delay);
  return kernel_.time() + kernel::milliseconds(delay - passed);
}

void Trace::begin(link::Event& event, link::EventKind kind, Stamp stamp, unsigned subject,
                  unsigned object) {
  event.time_us = stamp.time;
  event.step = stamp.step;
  event.kind = kind;
  event.value_count = 0;
  event.subject = static_cast<std::uint16_t>(subject);
  event.object = static_cast<std::uint16_t>(object);
}

void Trace::tell(link::EventKind kind, const Stamp& stamp, unsigned subject, unsigned object) {
  link::Event event;
  begin(event, kind, stamp, subject, object);
  sink_.emit(event);
}

void Trace::tell(link::EventKind kind, const Stamp& stamp, unsigned subject, unsigned object,
                 std::int32_t value) {
  link::Event event;
  begin(event, kind, stamp, subject, object);
  event.value_count = 1;
  event.values[0] = value;
  sink_.emit(event);
}

}  // namespace robosync::layers
