// Trace events (events.def): what the runtime did, when and why. The same on the host and on the board.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "link/messages.hpp"

namespace robosync::link {

enum class EventKind : std::uint8_t {
#define EVENT(name, number, subject, object, values, doc) name = (number),
#include "link/events.def"
#undef EVENT
};

inline constexpr std::size_t kMaxEventValues = 10;

// The object of lose and interrupt, instead of a behaviour, when a person has stopped the robot.
inline constexpr std::uint16_t kStop = 0xFFFF;

// The first value_count of `values` are valid; the others are undefined, because creating events on
// the board is time-critical. For `command`: [0] the word or -1, [1] the mask of given parameters,
// then their values in order.
struct Event {
  std::uint64_t time_us = 0;  // program time of the step
  std::uint32_t step = 0;
  EventKind kind{};
  std::uint8_t value_count = 0;
  std::uint16_t subject = 0;
  std::uint16_t object = 0;
  std::array<std::int32_t, kMaxEventValues> values;
};

// Largest wire form: time, step, kind, count, subject, object, then `count` values.
inline constexpr std::size_t kMaxEncodedEvent = 8 + 4 + 1 + 1 + 2 + 2 + 4 * kMaxEventValues;
static_assert(kMaxEncodedEvent <= kMaxPayload);

[[nodiscard]] bool known(EventKind kind);  // is it in events.def?

// Returns the length of the wire form. Sends at most kMaxEventValues values.
std::size_t encode_event(const Event& event, std::span<std::byte, kMaxEncodedEvent> out);
// False if the payload is not a complete event of a known kind.
[[nodiscard]] bool decode_event(std::span<const std::byte> payload, Event& event);

}  // namespace robosync::link
