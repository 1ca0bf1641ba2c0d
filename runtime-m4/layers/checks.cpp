// See checks.hpp. May rely on the verifier for indices, and for windows of at least 1.
#include "runtime-m4/layers/checks.hpp"

#include <algorithm>
#include <utility>

#include "runtime-m4/layers/clock.hpp"
#include "runtime-m4/policy/rules.hpp"

namespace robosync::layers {

void Checks::start(const vm::Image& image, Memory& memory) {
  wiring_ = image.checks;
  bands_ = image.bands;
  channels_ = image.channels.size();
  windows_ = memory.take<policy::Part::windows, Window>();
  room_ = {.samples = memory.take<policy::Part::samples, vm::Value>().data(),
           .order = memory.take<policy::Part::orders, std::uint8_t>().data()};
  unsigned used = 0;
  for (unsigned c = 0; c < wiring_.size(); ++c) {
    windows_[c].samples = MedianWindow(static_cast<std::uint16_t>(used));
    if (wiring_[c].window > 1) used += wiring_[c].window;
  }
}

bool Checks::update(unsigned check, std::uint32_t now, vm::Value* values) {
  const vm::Check& wiring = wiring_[check];
  vm::Value value = values[wiring.input];
  vm::Value& band = values[channels_ + wiring.variable];
  if (value == vm::kUnknown) [[unlikely]] {
    if (wiring.window > 1) windows_[check].forget();
    return std::exchange(band, value) != value;
  }
  if (wiring.window > 1) [[likely]]
    value = smoothed(check, now, value);
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

// The value is known. In the common cases, one sample is due: of a new value, or of the one that was held.
vm::Value Checks::smoothed(unsigned check, std::uint32_t now, vm::Value value) {
  Window& window = windows_[check];
  const std::uint32_t period_ms = policy::sample_period_ms(wiring_[check]);
  const std::uint32_t since = now - window.newest;
  vm::Value sample = value;
  std::uint32_t at = now;
  if ((since != period_ms || value == window.held) && !window.samples.is_empty()) {
    if (since <= period_ms || since >= 2 * period_ms) return smoothed_otherwise(check, now, value);
    sample = window.held;
    at = window.newest + period_ms;
  }
  window.held = value;
  return take(check, at, sample);
}

vm::Value Checks::take(unsigned check, std::uint32_t at, vm::Value sample) {
  Window& window = windows_[check];
  window.newest = at;
  return window.median = window.samples.push(room_, wiring_[check].window, sample);
}

// The samples of the held value that are due before `now`, and the new value, if that is a sample already.
[[gnu::noinline]] vm::Value Checks::smoothed_otherwise(unsigned check, std::uint32_t now,
                                                       vm::Value value) {
  Window& window = windows_[check];
  const std::uint32_t period_ms = policy::sample_period_ms(wiring_[check]);
  const vm::Value held = std::exchange(window.held, value);
  if (now == window.newest) return window.median = window.samples.replace_newest(room_, value);
  const std::uint32_t due = (now - window.newest - 1) / period_ms;
  for (std::uint32_t i = std::min<std::uint32_t>(due, wiring_[check].window); i > 0; --i)
    take(check, window.newest, held);
  window.newest += due * period_ms;
  if (now - window.newest == period_ms && value != held) take(check, now, value);
  return window.median;
}

// --- the bands ---

// The value is known.
vm::Value Checks::band_of(const vm::Check& check, vm::Value value, vm::Value before) const {
  const std::span bands = bands_.subspan(check.first_band, check.band_count);
  if (before != vm::kUnknown) {
    const vm::Band& last = bands[static_cast<std::size_t>(before) / vm::kScale];
    if (value >= last.stay_low && value <= last.stay_high) return before;
  }
  for (std::size_t b = 0; b < bands.size(); ++b)
    if (value >= bands[b].low && value <= bands[b].high)
      return static_cast<vm::Value>(b) * vm::kScale;
  return vm::kUnknown;
}

}  // namespace robosync::layers
