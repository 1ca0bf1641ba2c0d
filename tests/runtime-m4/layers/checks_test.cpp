// A smoothed CHECK, compared with one that takes each sample on its own and sorts all of them each time.
#include "runtime-m4/layers/checks.hpp"

#include <algorithm>
#include <array>
#include <deque>
#include <vector>

#include <catch2/catch.hpp>
#include <rapidcheck.h>

#include "runtime-m4/sim/arena.hpp"

using namespace robosync;

namespace {

// Each known value has a band of its own, so the band shows the median.
constexpr vm::Value kHighestDrawn = 6;

class PlainCheck {
public:
  PlainCheck(std::size_t window, std::uint32_t period) : window_(window), period_(period) {}

  vm::Value update(std::uint32_t now, vm::Value value) {
    if (value == vm::kUnknown) {
      samples_.clear();
      return value;
    }
    if (samples_.empty()) {
      sample(value, now);
    } else if (now == newest_) {
      samples_.back() = value;
    } else {
      while (now - newest_ > period_)
        sample(held_, newest_ + period_);
      if (now - newest_ == period_ && value != held_) sample(value, now);
    }
    held_ = value;
    std::vector<vm::Value> sorted(samples_.begin(), samples_.end());
    std::ranges::sort(sorted);
    return sorted[(sorted.size() - 1) / 2];
  }

private:
  void sample(vm::Value value, std::uint32_t at) {
    samples_.push_back(value);
    if (samples_.size() > window_) samples_.pop_front();
    newest_ = at;
  }

  std::size_t window_;
  std::uint32_t period_;
  std::deque<vm::Value> samples_;
  std::uint32_t newest_ = 0;
  vm::Value held_ = vm::kUnknown;
};

struct Smooth {
  explicit Smooth(std::uint16_t window, std::uint16_t sample_ms) {
    for (vm::Value v = 0; v <= kHighestDrawn; ++v)
      bands.push_back({.low = v, .high = v, .stay_low = 1, .stay_high = 0});
    check.front() = {.variable = 0,
                     .input = 0,
                     .first_band = 0,
                     .band_count = static_cast<std::uint8_t>(bands.size()),
                     .window = window,
                     .sample_ms = sample_ms};
    image.checks = check;
    image.bands = bands;
    image.channels = channels;
    policy::Needs needs = memory.needs();
    needs.counts[policy::Count::checks] = 1;
    needs.counts[policy::Count::samples] = window;
    memory.lay_out(needs);
    checks.start(image, memory);
  }
  vm::Value median() const {
    return values[1] == vm::kUnknown ? values[1] : values[1] / vm::kScale;
  }

  std::vector<vm::Band> bands;
  std::array<vm::Check, 1> check{};
  std::array<vm::Channel, 1> channels{};
  vm::Image image;
  sim::Arena arena;
  layers::Memory memory{arena.bytes(), arena.board()};
  layers::Checks checks;
  std::array<vm::Value, 2> values{vm::kUnknown, vm::kUnknown};
};

// Mostly one sample's time, or a millisecond more or less; sometimes none, several samples' time, or more than a window.
std::uint32_t drawn_time(std::uint32_t period) {
  return *rc::gen::weightedOneOf<std::uint32_t>(
      {{6, rc::gen::just(period)},
       {3, rc::gen::inRange(period - 1, period + 2)},
       {2, rc::gen::just(std::uint32_t{0})},
       {2, rc::gen::inRange(std::uint32_t{0}, 4 * period + 2)},
       {1, rc::gen::inRange(std::uint32_t{0}, 40 * period)}});
}

}  // namespace

TEST_CASE(
    "a smoothed CHECK samples as if each sample were taken on its own, whenever it is asked") {
  const bool holds = rc::check([] {
    const auto window = *rc::gen::inRange<std::uint16_t>(2, vm::kMaxWindow + 1);
    const auto sample_ms = *rc::gen::inRange<std::uint16_t>(0, 8);
    const std::uint32_t period = std::max<std::uint32_t>(sample_ms, 1);
    Smooth smooth(window, sample_ms);
    PlainCheck plain(window, period);
    std::uint32_t now = *rc::gen::element<std::uint32_t>(0, 1000, UINT32_MAX - 100);
    for (int i = 0; i < 150; ++i) {
      smooth.values[0] = *rc::gen::weightedOneOf<vm::Value>(
          {{30, rc::gen::inRange<vm::Value>(0, kHighestDrawn + 1)},
           {30, rc::gen::just(smooth.values[0])},
           {1, rc::gen::just(vm::kUnknown)}});
      const vm::Value before = smooth.values[1];
      const bool changed = smooth.checks.update(0, now, smooth.values.data());
      RC_ASSERT(smooth.median() == plain.update(now, smooth.values[0]));
      RC_ASSERT(changed == (smooth.values[1] != before));
      now += drawn_time(period);
    }
  });
  CHECK(holds);
}
