// See trace.hpp.
#include "runtime-m4/layers/trace.hpp"

namespace robosync::layers {

link::Event Trace::event(link::EventKind kind, Stamp stamp, unsigned subject, unsigned object) {
  link::Event event;
  event.time_us = stamp.time;
  event.step = stamp.step;
  event.kind = kind;
  event.subject = static_cast<std::uint16_t>(subject);
  event.object = static_cast<std::uint16_t>(object);
  return event;
}

void Trace::emit(link::EventKind kind, Stamp stamp, unsigned subject, unsigned object) {
  sink_.emit(event(kind, stamp, subject, object));
}

void Trace::emit(link::EventKind kind, Stamp stamp, unsigned subject, unsigned object,
                 std::int32_t value) {
  link::Event with_value = event(kind, stamp, subject, object);
  with_value.value_count = 1;
  with_value.values[0] = value;
  sink_.emit(with_value);
}

}  // namespace robosync::layers
