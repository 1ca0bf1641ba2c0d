// What a rule may do at which times, by its modifiers and time words, and which claim takes an
// actuator from which. Pure; used by layers/ and analysis/. Images are verified.
#pragma once

#include <algorithm>
#include <cstdint>

#include "vm/drivers.hpp"
#include "vm/image.hpp"

namespace robosync::policy {

// Converts a duration in thousandths of a second; negative ones give 0.
constexpr std::uint32_t milliseconds_of(vm::Value thousandths) {
  return static_cast<std::uint32_t>(std::max<vm::Value>(thousandths, 0));
}

// The time between two runs of an EVERY.
constexpr std::uint32_t period_ms(vm::Value thousandths) {
  return std::max<std::uint32_t>(milliseconds_of(thousandths), 1);
}

// The time between two samples of a CHECK with SMOOTH.
constexpr std::uint32_t sample_period_ms(const vm::Check& check) {
  return std::max<std::uint32_t>(check.sample_ms, 1);
}

// How often the safety thread checks its rules and the program's liveness when nothing wakes it earlier.
inline constexpr std::uint32_t kSafetyPeriodMs = 10;

// A moving actuator gets a setpoint in each such period: the frame of servos and PWM.
inline constexpr std::uint32_t kSetpointPeriodMs = 20;

// A THEN and a WAIT UNTIL last at least this long. So does the time from a response's beginning until it begins again without
// a new trigger, unless it has waited since. So no response takes the processor by going round without a WAIT.
inline constexpr std::uint32_t kLeastPauseMs = kSetpointPeriodMs;

// Ticks (of 1 ms) that a sensor waits at most for a bus transfer after its sample is due.
inline constexpr std::uint32_t kBusTicks = 2;

// Left for work that the processor does before it starts a bus, in microseconds.
inline constexpr std::uint32_t kBeforeBusUs = 100;

// All transfers that are requested from a bus at the same time must end within this time, in microseconds. They are requested
// `ahead_ms` ahead (bus_ahead_ms of the board's costs).
constexpr std::uint32_t bus_window_us(std::uint32_t ahead_ms) {
  return (ahead_ms + kBusTicks) * 1000 - kBeforeBusUs;
}

// From the trigger pulse of an echo sensor to its sample. If there is no echo within 38 ms, none comes.
inline constexpr std::uint32_t kEchoMs = 40;

// How many edges of an encoder a board counts from one sample to the next. The sample may be late by the time that the safety thread
// may be.
inline constexpr std::uint32_t kLateSampleMs = kSafetyPeriodMs;
constexpr std::uint32_t most_edges(std::uint16_t period_ms) {
  return vm::kEdgesPerMs * (period_ms + kLateSampleMs);
}

// How long each row of a board's lights is on.
inline constexpr std::uint32_t kRowMs = 2;

inline constexpr vm::Modifiers kPlain{};

inline const vm::Modifiers& modifiers_of(const vm::Image& image, const vm::Rule& rule) {
  return rule.modifiers == vm::kNoModifiers ? kPlain : image.modifiers[rule.modifiers];
}

// May the rule cool down or wait? Few rules do, so the times are kept for these only.
constexpr bool has_delays(const vm::Rule& rule) {
  return rule.modifiers != vm::kNoModifiers;
}

// Does the rule claim its actuators again after it has lost them, without a new trigger?
inline bool claims_again(const vm::Image& image, const vm::Rule& rule) {
  return rule.kind == vm::RuleKind::while_ || rule.kind == vm::RuleKind::when_else ||
         milliseconds_of(modifiers_of(image, rule).waiting) > 0;
}

// May a claim take an actuator from a response of behaviour `owner`? A trigger may take it from its
// own behaviour and from lower ones; a retried claim, from lower ones only. Behaviours are numbered
// from the highest priority down.
constexpr bool may_take(unsigned claimant, unsigned owner, bool retries) {
  return retries ? owner > claimant : owner >= claimant;
}

}  // namespace robosync::policy
