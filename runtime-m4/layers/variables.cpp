// See variables.hpp. May rely on the verifier: ranges are in order, fade is below 2^31.
#include "runtime-m4/layers/variables.hpp"

#include <algorithm>
#include <bit>

#include "runtime-m4/layers/clock.hpp"
#include "vm/arithmetic.hpp"

namespace robosync::layers {
namespace {

constexpr unsigned kFractionBits = 31;  // of vm::Variable::fade

vm::Value saturated(std::int64_t value) {
  return static_cast<vm::Value>(std::clamp<std::int64_t>(value, vm::kValueMin, vm::kValueMax));
}

std::uint32_t ticks_since(std::uint32_t since, std::uint32_t now) {
  return (now - since) / vm::kFadeTickMs;
}

}  // namespace

// By squaring: at most 32 rounds.
std::int64_t faded(std::int64_t distance, std::uint32_t fade, std::uint32_t ticks) {
  std::uint64_t left = std::uint64_t{1} << kFractionBits;
  std::uint64_t power = fade;
  for (; ticks != 0; ticks >>= 1) {
    if ((ticks & 1) != 0) left = left * power >> kFractionBits;
    power = power * power >> kFractionBits;
  }
  const auto size = static_cast<std::uint64_t>(distance < 0 ? -distance : distance);
  const auto rest = static_cast<std::int64_t>(size * left >> kFractionBits);
  return distance < 0 ? -rest : rest;
}

void Variables::start(const vm::Image& image, std::span<vm::Value> values,
                      const Beginnings& beginnings, Memory& memory) {
  image_ = &image;
  sums_ = memory.take<policy::Part::sums, vm::Value>();
  fades_ = memory.take_zero<policy::Part::fades, Fade>();
  entered_ = 0;
  staged_ = 0;
  set_ = 0;
  fading_ = 0;
  unsigned fading = 0;
  for (unsigned v = 0; v < image_->variables.size(); ++v)
    values[v] = initial_of(image, image.variables[v], beginnings.kept);
  beginnings.carried.apply(image, values);
  for (unsigned v = 0; v < image_->variables.size(); ++v) {
    if (image_->variables[v].fade == 0) continue;
    fading_ |= bit<VariableMask>(v);
    fades_[fading++] = {.from = values[v], .since = 0};
  }
}

// --- writes ---

void Variables::stage(const Written& written, const vm::Behavior& behavior,
                      const Snapshot& before) {
  stage_all<Rank::below_those_staged>(written, behavior, before);
}

void Variables::stage_first(const Written& written, const vm::Behavior& behavior,
                            const Snapshot& before) {
  stage_all<Rank::above_all>(written, behavior, before);
}

// The masks of written cells are not trusted: they come from a behaviour's thread.
template <Variables::Rank rank>
void Variables::stage_all(const Written& written, const vm::Behavior& behavior,
                          const Snapshot& before) {
  const std::uint8_t* const inputs = &image_->inputs[behavior.first_input];
  const auto channels = static_cast<unsigned>(image_->channels.size());
  const unsigned count = behavior.input_count;
  const std::uint32_t cells = count < 32 ? (std::uint32_t{1} << count) - 1 : UINT32_MAX;
  each_bit((written.assigned | written.shifted) & cells, [&](unsigned cell) {
    const std::uint8_t input = inputs[cell];
    if (input < channels) return;
    const bool set = has(written.assigned, cell);
    vm::Value value = written.frame[cell];
    if (!set) [[unlikely]]
      value = vm::subtract(value, before.value(input));
    if (value != vm::kUnknown) stage_one<rank>(input - channels, set, value);
  });
}

template <Variables::Rank rank>
[[gnu::always_inline]] inline void Variables::stage_one(unsigned variable, bool set,
                                                        vm::Value value) {
  const auto mine = bit<VariableMask>(variable);
  const auto lock = kernel_.lock();
  if (rank == Rank::below_those_staged && (set_ & mine) != 0) return;
  vm::Value& sum = sums_[variable];
  const bool adds = (staged_ & mine) != 0 && !(rank == Rank::above_all && set);
  sum = adds ? saturated(std::int64_t{sum} + value) : value;
  staged_ |= mine;
  if (set) set_ |= mine;
}

bool Variables::take(unsigned variable, Write& write) {
  const auto mine = bit<VariableMask>(variable);
  const auto lock = kernel_.lock();
  if ((staged_ & mine) == 0) return false;
  write = {.variable = static_cast<std::uint8_t>(variable),
           .set = (set_ & mine) != 0,
           .value = sums_[variable]};
  staged_ &= ~mine;
  set_ &= ~mine;
  return true;
}

vm::Value Variables::result_of(const vm::Variable& wiring, vm::Value before, const Write& write) {
  const std::int64_t result = write.set ? write.value : std::int64_t{before} + write.value;
  return std::clamp(saturated(result), wiring.min, wiring.max);
}

// --- the values ---

VariableMask Variables::enter(std::uint32_t now, std::span<vm::Value> values) {
  VariableMask changed = 0;
  unsigned fading = 0;
  entered_ = now;
  for (VariableMask left = staged_ | fading_; left != 0; left &= left - 1) {
    const auto v = static_cast<unsigned>(std::countr_zero(left));
    const vm::Variable& wiring = image_->variables[v];
    Fade* const fade = wiring.fade != 0 ? &fades_[fading++] : nullptr;
    vm::Value value = values[v];
    if (fade != nullptr) {
      const std::int64_t distance = std::int64_t{fade->from} - wiring.fades_to;
      value =
          saturated(wiring.fades_to + faded(distance, wiring.fade, ticks_since(fade->since, now)));
      // It stays there, even when `now` passes `since` again after 49 days.
      if (value == wiring.fades_to) fade->from = value;
    }
    Write write{};
    if (take(v, write)) {
      value = result_of(wiring, value, write);
      if (fade != nullptr) *fade = {.from = value, .since = now};
    }
    if (value == values[v]) continue;
    values[v] = value;
    changed |= bit<VariableMask>(v);
  }
  return changed;
}

std::uint32_t Variables::next_fade(std::uint32_t now, std::span<const vm::Value> values) const {
  Soonest next(now);
  unsigned fading = 0;
  for (VariableMask left = fading_; left != 0; left &= left - 1) {
    const auto v = static_cast<unsigned>(std::countr_zero(left));
    const std::uint32_t since = fades_[fading++].since;
    if (values[v] == image_->variables[v].fades_to) continue;
    next.surely_at(since + (ticks_since(since, entered_) + 1) * vm::kFadeTickMs);
  }
  return next.delay();
}

}  // namespace robosync::layers
