// See checks.hpp. May rely on the verifier for places and windows of at least 1, and on fits() for
// the room for all windows.
#include "runtime-m4/layers/checks.hpp"

#include <algorithm>

#include "runtime-m4/layers/clock.hpp"
#include "runtime-m4/policy/rules.hpp"

namespace robosync::layers {
void Checks::start(const vm::Image& image) {
  wiring_ = image.checks;
  bands_ = image.bands;
  channels_ = image.channels.size();
  windows_.fill({});
  unsigned used = 0;
  for (unsigned c = 0; c < wiring_.size(); ++c) {
    windows_[c].first = static_cast<std::uint8_t>(used);
    if (wiring_[c].window > 1) used += wiring_[c].window;
  }
}

bool Checks::update(unsigned check, std::uint32_t now, std::span<vm::Value> values) {
  const vm::Check& wiring = wiring_[check];
  vm::Value value = values[wiring.input];
  if (wiring.window > 1) {
    Window& window = windows_[check];
    const Samples samples = std::span(samples_).subspan(window.first, wiring.window);
    value = smoothed(window, samples, policy::sample_period_ms(wiring), now, value);
  }
  vm::Value& band = values[channels_ + wiring.variable];
  const vm::Value before = band;
  band = band_of(wiring, value, before);
  return band != before;
}

std::uint32_t Checks::next(std::uint32_t now) const {
  Soonest next(now);
  for (unsigned c = 0; c < wiring_.size(); ++c) {
    // Once what is held is the median, more of it changes nothing.
    if (windows_[c].held == windows_[c].median) continue;
    next.at(windows_[c].newest + policy::sample_period_ms(wiring_[c]));
  }
  return next.delay();
}

// --- the window ---

vm::Value Checks::smoothed(Window& window, Samples samples, unsigned period_ms, std::uint32_t now,
                           vm::Value value) {
  if (value == vm::kUnknown) {
    window = {.first = window.first};
    return value;
  }
  const std::uint32_t since = now - window.newest;
  if (window.count == 0) {
    window.newest = now;
    push(window, samples, value);
  } else if (since == 0) {
    samples[window.head] = value;
  } else if (const std::uint32_t instants = since / period_ms; instants > 0) {
    const bool now_is_one = since % period_ms == 0;
    const std::size_t passed = std::min<std::size_t>(instants - now_is_one, samples.size());
    for (std::size_t i = 0; i < passed; ++i)
      push(window, samples, window.held);
    if (now_is_one) push(window, samples, value);
    window.newest += instants * period_ms;
  } else {
    window.held = value;
    return window.median;
  }
  window.held = value;
  window.median = median(window, samples);
  return window.median;
}

void Checks::push(Window& window, Samples samples, vm::Value value) {
  window.head = static_cast<std::uint8_t>((window.head + 1U) % samples.size());
  samples[window.head] = value;
  if (window.count < samples.size()) ++window.count;
}

// By counting, so that no copy is needed: windows are short (vm::kMaxWindow). The samples stand at
// head and before, around the end.
vm::Value Checks::median(const Window& window, Samples samples) {
  const unsigned middle = (window.count - 1U) / 2;
  const auto sample = [&](unsigned age) {
    return samples[(window.head + samples.size() - age) % samples.size()];
  };
  for (unsigned i = 0; i < window.count; ++i) {
    unsigned less = 0;
    unsigned equal = 0;
    for (unsigned j = 0; j < window.count; ++j) {
      if (sample(j) < sample(i)) ++less;
      if (sample(j) == sample(i)) ++equal;
    }
    if (less <= middle && middle < less + equal) return sample(i);
  }
  return vm::kUnknown;  // of no samples
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
