// Trace events to their wire form and back.
#include "link/events.hpp"

#include <algorithm>

#include "link/wire.hpp"

namespace robosync::link {
namespace {

#pragma pack(push, 1)
struct EventHead {
  std::uint64_t time_us;
  std::uint32_t step;
  EventKind kind;
  std::uint8_t value_count;
  std::uint16_t subject;
  std::uint16_t object;
};
#pragma pack(pop)

static_assert(sizeof(EventHead) == kMaxEncodedEvent - sizeof(Event::values));

}  // namespace

bool known(EventKind kind) {
  switch (kind) {
#define EVENT(name, number, subject, object, values, doc) case EventKind::name:
#include "link/events.def"
#undef EVENT
    return true;
  }
  return false;
}

std::size_t encode_event(const Event& event, std::span<std::byte, kMaxEncodedEvent> out) {
  const auto count =
      static_cast<std::uint8_t>(std::min<std::size_t>(event.value_count, kMaxEventValues));
  const EventHead head{event.time_us, event.step, event.kind, count, event.subject, event.object};
  const std::size_t values = count * sizeof event.values[0];
  std::memcpy(out.data(), &head, sizeof head);
  std::memcpy(out.data() + sizeof head, event.values.data(), values);
  return sizeof head + values;
}

bool decode_event(std::span<const std::byte> payload, Event& event) {
  EventHead head{};
  if (!read_prefix(payload, head) || head.value_count > kMaxEventValues || !known(head.kind)) {
    return false;
  }
  const auto values = payload.subspan(sizeof head);
  if (values.size() != head.value_count * sizeof event.values[0]) return false;
  event = {head.time_us, head.step, head.kind, head.value_count, head.subject, head.object, {}};
  if (!values.empty()) std::memcpy(event.values.data(), values.data(), values.size());
  return true;
}

}  // namespace robosync::link
