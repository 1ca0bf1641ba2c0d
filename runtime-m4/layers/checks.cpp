// See checks.hpp. May rely on the verifier for indices, and for windows of at least 1.
#include "runtime-m4/layers/checks.hpp"

#include <algorithm>

#include "runtime-m4/layers/clock.hpp"
#include "runtime-m4/policy/rules.hpp"

namespace robosync::layers {
void Checks::start(const vm::Image& image, Memory& memory) {
  wiring_ = image.checks;
  bands_ = image.bands;
  channels_ = image.channels.size();
  windows_ = memory.take<policy::Part::windows, Window>();
  samples_ = memory.take<policy::Part::samples, vm::Value>();
  orders_ = memory.take<policy::Part::orders, std::uint8_t>();
  unsigned used = 0;
  for (unsigned c = 0; c < wiring_.size(); ++c) {
    windows_[c].first = static_cast<std::uint16_t>(used);
    if (wiring_[c].window > 1) used += wiring_[c].window;
  }
}

bool Checks::update(unsigned check, std::uint32_t now, std::span<vm::Value> values) {
  const vm::Check& wiring = wiring_[check];
  vm::Value value = values[wiring.input];
  if (wiring.window > 1) value = smoothed(windows_[check], wiring, now, value);
  vm::Value& band = values[channels_ + wiring.variable];
  const vm::Value before = band;
  band = band_of(wiring, value, before);
  return band != before;
}

std::uint32_t Checks::next(std::uint32_t now) const {
  Soonest next(now);
  for (unsigned c = 0; c < wiring_.size(); ++c) {
    // Once the held value is the median, more samples of it change nothing.
    if (windows_[c].held == windows_[c].median) continue;
    next.surely_at(windows_[c].newest + policy::sample_period_ms(wiring_[c]) + 1);
  }
  return next.delay();
}

// --- the window ---

vm::Value Checks::smoothed(Window& window, const vm::Check& wiring, std::uint32_t now,
                           vm::Value value) {
  if (value == vm::kUnknown) {
    window.held = window.median = value;
    window.samples = {};
    return value;
  }
  const unsigned size = wiring.window;
  MedianWindow samples({&samples_[window.first], size}, {&orders_[window.first], size},
                       window.samples);
  const std::uint32_t period_ms = policy::sample_period_ms(wiring);
  const std::uint32_t since = now - window.newest;
  // The common case first: a new reading in each period.
  if (window.samples.count == 0 || (since == period_ms && value != window.held)) {
    window.newest = now;
    samples.push(value);
  } else if (since == 0) {
    samples.replace_newest(value);
  } else if (const std::uint32_t over = (since - 1) / period_ms; over > 0) {
    for (std::uint32_t i = std::min<std::uint32_t>(over, size); i > 0; --i)
      samples.push(window.held);
    window.newest += over * period_ms;
    if (now - window.newest == period_ms && value != window.held) {
      window.newest = now;
      samples.push(value);
    }
  } else {
    window.held = value;
    return window.median;
  }
  window.held = value;
  window.median = samples.median();
  return window.median;
}

// --- the bands ---

vm::Value Checks::band_of(const vm::Check& check, vm::Value value, vm::Value before) const {
  if (value == vm::kUnknown) return vm::kUnknown;
  const std::span bands = bands_.subspan(check.first_band, check.band_count);
  if (before != vm::kUnknown) {
    const vm::Band& last = bands[static_cast<std::size_t>(before / vm::kScale)];
    if (value >= last.stay_low && value <= last.stay_high) return before;
  }
  for (std::size_t b = 0; b < bands.size(); ++b)
    if (value >= bands[b].low && value <= bands[b].high)
      return static_cast<vm::Value>(b) * vm::kScale;
  return vm::kUnknown;
}

}  // namespace robosync::layers
