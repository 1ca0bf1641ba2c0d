// Policy of adaptive priorities (the paper's ΔP = α·F/W): the priority of a behaviour after a window
// in which it was triggered F times. Pure, whole numbers only, so host and board agree.
//
// The result is computed from the base each time, never from the last result. So a behaviour that
// calms down returns to its written priority one window later, and none drifts to the cap. Safety
// ranks above all priorities (standing.hpp), whatever the cap.
#pragma once

#include <algorithm>
#include <cstdint>

#include "runtime-m4/policy/standing.hpp"
#include "vm/image.hpp"

namespace robosync::policy {

struct AdaptationRule {
  std::uint16_t alpha = 0;  // thousandths; 0: every behaviour keeps its base
  std::uint16_t window_ms = 1;
  std::int8_t cap = 0;  // highest priority after a raise; a base above it is kept
};

// The rule of a program; without one, all behaviours keep their base.
inline AdaptationRule adaptation_of(const vm::Image& image) {
  if (image.adaptations.empty()) return {};
  const vm::Adaptation& wiring = image.adaptations.front();
  return {wiring.alpha, wiring.window_ms, static_cast<std::int8_t>(wiring.cap)};
}

// F, saturating at kMostTriggers. The product with alpha fits in 32 bits.
using TriggerCount = std::uint16_t;
inline constexpr TriggerCount kMostTriggers = 0xFFFF;

// The highest priority that a behaviour with this base can get.
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
