// Policy of adaptive priorities (the paper's ΔP = α·F/W): what a behaviour is worth after a window
// in which it was triggered F times. Pure, whole numbers only, so host and board agree.
//
// The result is worked out from the base each time, never from the last result: a behaviour that
// calms down is back where it was written one window later, and none drifts to the cap. Safety is
// beyond all priorities (standing.hpp), whatever the cap.
#pragma once

#include <algorithm>
#include <cstdint>

#include "runtime-m4/policy/standing.hpp"
#include "vm/image.hpp"

namespace robosync::policy {

struct AdaptationRule {
  std::uint16_t alpha = 0;  // thousandths; 0: every behaviour keeps its base
  std::uint16_t window_ms = 1;
  std::int8_t cap = 0;  // nobody is raised beyond it; who is written above it stays there
};

// Of a program; without one, all keep their base.
inline AdaptationRule adaptation_of(const vm::Image& image) {
  if (image.adaptations.empty()) return {};
  const vm::Adaptation& wiring = image.adaptations.front();
  return {wiring.alpha, wiring.window_ms, static_cast<std::int8_t>(wiring.cap)};
}

// F as it is counted: what does not fit counts as the most. The product with alpha fits in 32 bits.
using TriggerCount = std::uint16_t;
inline constexpr TriggerCount kMostTriggers = 0xFFFF;

// The most that a behaviour with this base can be worth.
constexpr std::int8_t ceiling(std::int8_t base, std::int8_t cap) {
  return std::max(base, cap);
}

constexpr Priority adapted(std::int8_t base, TriggerCount triggers, const AdaptationRule& rule) {
  const std::int32_t room = ceiling(base, rule.cap) - base;
  const std::uint32_t raise = std::uint32_t{rule.alpha} * triggers / rule.window_ms;
  const std::uint32_t given = std::min(raise, static_cast<std::uint32_t>(room));
  return {static_cast<std::int8_t>(base + static_cast<std::int32_t>(given)), base};
}

}  // namespace robosync::policy
