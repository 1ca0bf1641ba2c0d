// A movement of two wheels that goes by what their encoders count: when it ends, which wheel gets less power meanwhile, and when it
// is given up. In integers; ways are in thousandths of a millimetre.
//
//   end      each wheel has made the edge that is nearest to its target. It is looked at kShortestLookMs after that at the latest
//   trim     the wheel that is ahead gets 1 % less power for each kTrimStep, at most kMostTrimPercent less
//   blocked  a wheel that should turn has made no edge for kPatienceMs and as long as kPatienceEdges take at its speed, or the board
//            has lost edges of it
//
// An edge counts as made only if the wheel has never been further: one that rocks to and fro is blocked, too.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "runtime-m4/policy/encoder_count.hpp"
#include "runtime-m4/policy/rules.hpp"
#include "vm/drive.hpp"

namespace robosync::policy {

inline constexpr std::uint32_t kPatienceMs = 500, kPatienceEdges = 4;
inline constexpr std::uint32_t kShortestLookMs = 5, kLongestLookMs = kSetpointPeriodMs;
inline constexpr std::int64_t kTrimStep = 250;  // 0.25 mm
inline constexpr std::int64_t kMostTrimPercent = 25;

// How often a moving actuator is called at most.
constexpr std::uint32_t shortest_setpoint_ms(const vm::Image& image, std::size_t actuator) {
  return vm::is_counted_drive(image, actuator) ? kShortestLookMs : kSetpointPeriodMs;
}

using EncoderCounts = std::array<EncoderCount, 2>;

class Travel {
public:
  enum class State : std::uint8_t { going, arrived, blocked };
  // Of a movement that ends otherwise.
  static constexpr std::int64_t kNoTarget = INT64_MAX;

  // Each wheel goes this way at `speed`, which is above 0; `back`: its encoder counts it backward.
  void begin(const vm::WheelEncoders& encoders, const EncoderCounts& counted,
             std::array<bool, 2> back, std::int64_t way, vm::Value speed, std::uint32_t now_ms) {
    for (std::size_t side = 0; side < wheels_.size(); ++side) {
      const vm::WheelEncoder& encoder = encoders[side];
      wheels_[side] = {.above = encoder.above,
                       .begun = counted[side].edges,
                       .goal = nearest_edge(way, encoder),
                       .made = 0,
                       .edge_us = time_of_edge(encoder, speed),
                       .made_at = now_ms,
                       .below = encoder.below,
                       .losses = counted[side].losses,
                       .back = back[side]};
    }
    is_on_ = true;
  }
  void end() { is_on_ = false; }
  [[nodiscard]] bool is_on() const { return is_on_; }

  State look(const EncoderCounts& counted, std::uint32_t now_ms) {
    bool arrived = true;
    for (std::size_t side = 0; side < wheels_.size(); ++side) {
      Wheel& wheel = wheels_[side];
      if (counted[side].losses != wheel.losses) return State::blocked;
      see(wheel, counted[side], now_ms);
      if (has_arrived(wheel)) continue;
      arrived = false;
      if (now_ms - wheel.made_at > patience_ms(wheel)) return State::blocked;
    }
    return arrived ? State::arrived : State::going;
  }

  [[nodiscard]] bool has_arrived(vm::Side side) const {
    return has_arrived(wheels_[static_cast<std::size_t>(side)]);
  }
  // The part of its power that a wheel gets, in percent.
  [[nodiscard]] std::int32_t share(vm::Side side) const {
    const Wheel& wheel = wheels_[static_cast<std::size_t>(side)];
    const Wheel& other = wheels_[1 - static_cast<std::size_t>(side)];
    if (has_arrived(wheel)) return 0;
    if (has_arrived(other)) return 100;
    const std::int64_t ahead = way_of(wheel) - way_of(other);
    return static_cast<std::int32_t>(
        100 - std::clamp<std::int64_t>(ahead / kTrimStep, 0, kMostTrimPercent));
  }

  // Until the first of the wheels may arrive, at the speed that was ordered: its latest edge was seen at most kLongestLookMs late.
  [[nodiscard]] std::uint32_t next_look_ms(std::uint32_t now_ms) const {
    std::uint64_t soonest = std::uint64_t{kLongestLookMs} * 1000;
    for (const Wheel& wheel : wheels_) {
      if (has_arrived(wheel)) continue;
      const auto takes = static_cast<std::uint64_t>(wheel.goal - wheel.made) * wheel.edge_us;
      const auto passed = std::uint64_t{now_ms - wheel.made_at + kLongestLookMs} * 1000;
      soonest = std::min(soonest, takes > passed ? takes - passed : 0);
    }
    return std::max(static_cast<std::uint32_t>((soonest + 999) / 1000), kShortestLookMs);
  }

  // What both have made, on average.
  [[nodiscard]] std::int64_t way() const { return (way_of(wheels_[0]) + way_of(wheels_[1])) / 2; }

private:
  struct Wheel {
    std::int32_t above;       // an edge is `above` / `below` of the way
    std::int32_t begun;       // what was counted when it began
    std::int32_t goal, made;  // edges
    std::uint32_t edge_us;    // how long an edge takes
    std::uint32_t made_at;    // when the latest one was seen
    std::uint16_t below;
    std::uint8_t losses;  // when it began
    bool back;
  };

  static std::int32_t nearest_edge(std::int64_t way, const vm::WheelEncoder& encoder) {
    if (way == kNoTarget) return INT32_MAX;
    const std::int64_t edges = (way * encoder.below + encoder.above / 2) / encoder.above;
    return static_cast<std::int32_t>(std::min<std::int64_t>(edges, INT32_MAX));
  }
  static std::uint32_t time_of_edge(const vm::WheelEncoder& encoder, vm::Value speed) {
    const std::int64_t time =
        std::int64_t{encoder.above} * 1'000'000 / (std::int64_t{speed} * encoder.below);
    return static_cast<std::uint32_t>(std::min<std::int64_t>(time, UINT32_MAX));
  }
  static bool has_arrived(const Wheel& wheel) { return wheel.made >= wheel.goal; }
  static std::int64_t way_of(const Wheel& wheel) {
    return std::int64_t{wheel.made} * wheel.above / wheel.below;
  }
  static std::uint32_t patience_ms(const Wheel& wheel) {
    return kPatienceMs + wheel.edge_us / 1000 * kPatienceEdges;
  }
  static void see(Wheel& wheel, const EncoderCount& counted, std::uint32_t now_ms) {
    const std::uint32_t passed =
        static_cast<std::uint32_t>(counted.edges) - static_cast<std::uint32_t>(wheel.begun);
    const auto made = static_cast<std::int32_t>(wheel.back ? 0 - passed : passed);
    if (made <= wheel.made) return;
    wheel.made = made;
    wheel.made_at = now_ms;
  }

  std::array<Wheel, 2> wheels_{};
  bool is_on_ = false;
};

}  // namespace robosync::policy
