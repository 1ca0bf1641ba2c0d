// What a rule may do when, as its modifiers and the time words say it, and who gives way to whom.
// Pure; layers/ act by it, analysis/ counts by it. Images are verified.
#pragma once

#include <algorithm>
#include <cstdint>

#include "vm/image.hpp"

namespace robosync::policy {

// Of a duration in thousandths of a second; none is negative.
constexpr std::uint32_t milliseconds_of(vm::Value thousandths) {
  return static_cast<std::uint32_t>(std::max<vm::Value>(thousandths, 0));
}

// Between two turns of an EVERY.
constexpr std::uint32_t period_ms(vm::Value thousandths) {
  return std::max<std::uint32_t>(milliseconds_of(thousandths), 1);
}

// Between two samples of a CHECK that smooths.
constexpr std::uint32_t sample_period_ms(const vm::Check& check) {
  return std::max<std::uint32_t>(check.sample_ms, 1);
}

// How often the safety thread looks when nothing calls it: at the rules, and at the program's life.
inline constexpr std::uint32_t kSafetyPeriodMs = 10;

// What a moving actuator gets its next setpoint in: the frame of servos and PWM.
inline constexpr std::uint32_t kSetpointPeriodMs = 20;

// How long who has asked a bus waits at most, once the answer is due, in ticks of a millisecond.
inline constexpr std::uint32_t kBusTicks = 2;

// In what all that is asked of a bus at once must be over, in microseconds: it is asked a tick ahead. The rest is for what the
// processor does first.
inline constexpr std::uint32_t kBusWindowUs = (1 + kBusTicks) * 1000 - 100;

// From the pulse that asks for an echo to the sample: who has heard nothing after 38 ms hears nothing.
inline constexpr std::uint32_t kEchoMs = 40;

// How long a row of a board's lights is on, until the next one is.
inline constexpr std::uint32_t kRowMs = 2;

inline constexpr vm::Modifiers kPlain{};

inline const vm::Modifiers& modifiers_of(const vm::Image& image, const vm::Rule& rule) {
  return rule.modifiers == vm::kNoModifiers ? kPlain : image.modifiers[rule.modifiers];
}

// May it cool down or wait? Few do, so that times of these are kept for those alone.
constexpr bool has_delays(const vm::Rule& rule) {
  return rule.modifiers != vm::kNoModifiers;
}

// Does it claim its actuators again after it has lost them, without a new trigger?
inline bool claims_again(const vm::Image& image, const vm::Rule& rule) {
  return rule.kind == vm::RuleKind::while_ || rule.kind == vm::RuleKind::when_else ||
         milliseconds_of(modifiers_of(image, rule).waiting) > 0;
}

// May a claim take an actuator from a response of behaviour `owner`? A trigger takes from its own
// behaviour and from lower ones; a claim that is tried again, from lower ones only. Behaviours are
// numbered from the highest priority down.
constexpr bool may_take(unsigned claimant, unsigned owner, bool retries) {
  return retries ? owner > claimant : owner >= claimant;
}

}  // namespace robosync::policy
