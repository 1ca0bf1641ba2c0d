// Times of traces, in microseconds, and of TESTs, in milliseconds.
#pragma once

#include <cstdint>
#include <string>

#include <fmt/format.h>

namespace robosync::tool {

inline constexpr std::uint64_t kMicroseconds = 1000;  // in a millisecond

// "2.040 s", to the millisecond; the seconds take at least `width` places.
[[nodiscard]] inline std::string seconds_text(std::uint64_t time_us, int width = 0) {
  return fmt::format("{:{}}.{:03} s", time_us / (kMicroseconds * kMicroseconds), width,
                     time_us / kMicroseconds % kMicroseconds);
}

}  // namespace robosync::tool
