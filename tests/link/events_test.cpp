// Trace events: round trip, and refusal of anything that is not a whole event.
#include "link/events.hpp"

#include <vector>

#include <catch2/catch.hpp>

using namespace robosync::link;

namespace {

Event sample(std::uint8_t values) {
  Event event{123'456'789'012, 42, EventKind::command, values, 300, 7, {}};
  for (std::uint8_t i = 0; i < values; ++i)
    event.values[i] = -1000 * i;
  return event;
}

std::vector<std::byte> encoded(const Event& event) {
  std::array<std::byte, kMaxEncodedEvent> out{};
  const std::size_t length = encode_event(event, out);
  return {out.begin(), out.begin() + static_cast<std::ptrdiff_t>(length)};
}

}  // namespace

TEST_CASE("an event arrives as it was sent, with any number of values") {
  for (std::uint8_t count = 0; count <= kMaxEventValues; ++count) {
    const Event sent = sample(count);
    Event got;
    REQUIRE(decode_event(encoded(sent), got));
    CHECK(got.time_us == sent.time_us);
    CHECK(got.step == sent.step);
    CHECK(got.kind == sent.kind);
    CHECK(got.value_count == sent.value_count);
    CHECK(got.subject == sent.subject);
    CHECK(got.object == sent.object);
    CHECK(got.values == sent.values);
  }
}

TEST_CASE("more values than fit are not sent") {
  Event event = sample(kMaxEventValues);
  event.value_count = 255;
  Event got;
  REQUIRE(decode_event(encoded(event), got));
  CHECK(got.value_count == kMaxEventValues);
}

TEST_CASE("a payload of any other length is no event") {
  std::vector<std::byte> payload = encoded(sample(3));
  Event got;
  for (std::size_t length = 0; length < payload.size(); ++length) {
    INFO(length);
    CHECK_FALSE(decode_event(std::span(payload).first(length), got));
  }
  payload.push_back(std::byte{0});
  CHECK_FALSE(decode_event(payload, got));
}

TEST_CASE("an unknown kind or count is no event") {
  Event event = sample(0);
  event.kind = static_cast<EventKind>(0);
  Event got;
  CHECK_FALSE(decode_event(encoded(event), got));
  event.kind = static_cast<EventKind>(255);
  CHECK_FALSE(decode_event(encoded(event), got));

  std::vector<std::byte> payload = encoded(sample(kMaxEventValues));
  payload[13] = static_cast<std::byte>(kMaxEventValues + 1);
  payload.resize(payload.size() + 4);
  CHECK_FALSE(decode_event(payload, got));
}
