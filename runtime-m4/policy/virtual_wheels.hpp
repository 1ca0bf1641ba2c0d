// The encoders' wheels where there are none, in a simulation and on the emulated board: each turns at once as fast as the power of
// its motor says, and stands at once without power. In integers, so both count the same edges.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "vm/drivers.hpp"

namespace robosync::policy {

class VirtualWheels {
public:
  // How fast a wheel turns is said in this part of an edge per second.
  static constexpr std::int64_t kRateParts = 256;
  static constexpr std::int64_t kMostRate = 10'000 * kRateParts;

  // The wheel of this encoder stands, and has no edge yet; with full power it will turn at this rate, at most kMostRate. `number`
  // is below vm::kMaxEncoders throughout. Times are the kernel's, in microseconds, modulo 2^32.
  void begin(unsigned number, std::int32_t full_rate, std::uint32_t now) {
    wheels_[number] = {.since = now, .full_rate = full_rate, .is_on = true};
  }
  void end_all() { wheels_ = {}; }
  [[nodiscard]] bool is_on(unsigned number) const { return wheels_[number].is_on; }

  // From now on its motor gets this pulse in each frame of 20 ms, negative backward; again at least every kLongest microseconds
  // while it turns. Divides nothing: it is called deep in stacks.
  void turn(unsigned number, std::int32_t pulse_us, std::uint32_t now) {
    Wheel& wheel = wheels_[number];
    wheel.parts = parts_at(wheel, now);
    if (wheel.parts >= kMany || wheel.parts <= -kMany) {
      const bool back = wheel.parts < 0;
      wheel.parts += back ? kMany : -kMany;
      wheel.edges += back ? 0 - kManyEdges : kManyEdges;
    }
    wheel.since = now;
    wheel.rate = std::int64_t{wheel.full_rate} * pulse_us;
  }

  // Forward, less those backward.
  [[nodiscard]] std::int32_t edges(unsigned number, std::uint32_t now) const {
    const Wheel& wheel = wheels_[number];
    const std::int64_t parts = parts_at(wheel, now);
    const std::int64_t whole = (parts - (parts < 0 ? kEdge - 1 : 0)) / kEdge;
    return static_cast<std::int32_t>(wheel.edges + static_cast<std::uint32_t>(whole));
  }
  // How long ago the last one was, in microseconds, as if it had turned as now since then.
  [[nodiscard]] std::uint32_t ago(unsigned number, std::uint32_t now) const {
    const Wheel& wheel = wheels_[number];
    if (wheel.rate == 0) return now - wheel.since;
    const std::int64_t past = (parts_at(wheel, now) % kEdge + kEdge) % kEdge;
    const std::int64_t time = wheel.rate > 0 ? past / wheel.rate : (kEdge - past) / -wheel.rate;
    return static_cast<std::uint32_t>(std::min<std::int64_t>(time, INT32_MAX));
  }

private:
  // Of an edge: a rate of one turns the wheel by a part in each microsecond of a pulse, and of time.
  static constexpr std::int64_t kEdge = kRateParts * 20'000 * 1'000'000;
  static constexpr std::uint32_t kManyEdges = 1U << 16;
  static constexpr std::int64_t kMany = kEdge * kManyEdges;
  static constexpr std::uint32_t kLongest = 1U << 26;
  static_assert(kMostRate * 20'000 * kLongest + kMany < INT64_MAX);

  struct Wheel {
    std::int64_t parts = 0;   // besides the edges
    std::int64_t rate = 0;    // parts in a microsecond
    std::uint32_t since = 0;  // when the parts were so many
    std::uint32_t edges = 0;
    std::int32_t full_rate = 0;
    bool is_on = false;
  };

  // A time before `since` is one of a thread that was preempted by the thread that turned the wheel.
  static std::int64_t parts_at(const Wheel& wheel, std::uint32_t now) {
    const std::uint32_t passed = now - wheel.since;
    return wheel.parts + (passed <= kLongest ? wheel.rate * std::int64_t{passed} : 0);
  }

  std::array<Wheel, vm::kMaxEncoders> wheels_{};
};

}  // namespace robosync::policy
