// See replay_feeder.hpp.
#include "rsc/trace/replay_feeder.hpp"

#include <algorithm>
#include <iterator>
#include <string_view>

#include "rsc/json.hpp"
#include "rsc/trace/replay_event.hpp"
#include "rsc/trace/time_units.hpp"

namespace robosync::tool {
namespace {

// Events that the board stamps with the time of a step; other events have their own times.
bool is_of_step(const Json& event) {
  constexpr std::string_view kOfStep[] = {"input",     "stale",   "set",        "fire",
                                          "win",       "lose",    "go_on",      "wait",
                                          "interrupt", "overrun", "zero_divide"};
  return std::ranges::find(kOfStep, kind_of(event)) != std::end(kOfStep) && !is_beginning(event);
}

std::string about(const Json& event) {
  std::string text = kind_of(event);
  for (const char* const key : {"sensor", "channel", "variable", "rule", "actuator"})
    if (const auto found = event.find(key); found != event.end()) text += ' ' + found->dump();
  return text;
}

std::span<const Told> readings_of_first_step(std::span<const Told> readings) {
  const auto is_other = [&](const Told& told) { return told.step != readings.front().step; };
  const auto end = std::ranges::find_if(readings, is_other);
  return readings.first(static_cast<std::size_t>(end - readings.begin()));
}

}  // namespace

ReplayFeeder::ReplayFeeder(sim::Simulator& simulator, const RecordedProgram& recorded,
                           const vm::Image& image, const Readings& readings,
                           const std::set<std::uint8_t>& silent)
    : simulator_(simulator),
      image_(image),
      readings_(readings),
      silent_(silent),
      end_us_(time_of(recorded.events.back().event)) {
  std::map<std::string, std::size_t> counts;
  for (const auto& [line, event] : recorded.events) {
    if (!is_of_step(event)) continue;
    const std::string what = about(event);
    recorded_[{time_of(event), step_of(event)}] = {what, ++counts[what]};
  }
}

void ReplayFeeder::run() {
  for (std::span<const Told> left(readings_); !left.empty();) {
    held_ = readings_of_first_step(left);
    left = left.subspan(held_.size());
    const std::uint64_t at_us = held_.front().at_us;
    awaited_ = step_before(held_.front());
    if (awaited_ != nullptr) simulator_.run_until(at_us);
    feed_held();
  }
  simulator_.run_until(end_us_);
}

// Another step may follow in the same millisecond, which must have the readings, if the recorded one had them.
void ReplayFeeder::see(const Json& event) {
  if (!is_of_step(event)) return;
  const std::string what = about(event);
  const std::size_t number = ++seen_[what];
  if (awaited_ != nullptr && awaited_->about == what && awaited_->number == number) feed_held();
}

// An earlier step in the millisecond of the reading did not have it. Null: there is none, or this robot has made it already.
const ReplayFeeder::Mark* ReplayFeeder::step_before(const Told& told) {
  if (told.came_earlier) return nullptr;
  auto found = recorded_.lower_bound({told.at_us, told.step});
  if (found == recorded_.begin() || (--found)->first.first != told.at_us) return nullptr;
  const Mark& mark = found->second;
  return seen_[mark.about] < mark.number ? &mark : nullptr;
}

void ReplayFeeder::feed_held() {
  awaited_ = nullptr;
  for (const Told& told : std::exchange(held_, {})) {
    if (!told.value) continue;
    simulator_.feed(told.at_us, told.channel, *told.value);
    if (silent_.contains(told.channel)) repeat(told);
  }
}

// A channel that can become silent gets its value again until then; it becomes silent `life` after the last one
// (layers/mailbox.hpp).
void ReplayFeeder::repeat(const Told& told) {
  const auto next =
      std::find_if(readings_.begin() + (&told - readings_.data()) + 1, readings_.end(),
                   [&](const Told& other) { return other.channel == told.channel; });
  const bool is_last = next == readings_.end();
  const std::uint64_t life_us = (image_.channels[told.channel].stale_ms + 1U) * kMicroseconds;
  const std::uint64_t again_us = std::max(life_us / 2, kMicroseconds);
  const std::uint64_t next_us = is_last ? end_us_ : next->at_us;
  const bool falls_silent = !is_last && !next->value;
  std::uint64_t until_us = next_us;
  if (falls_silent) until_us = next_us > life_us ? next_us - life_us : 0;
  for (std::uint64_t at = told.at_us + again_us; at < until_us; at += again_us)
    simulator_.feed(at, told.channel, *told.value);
  if (falls_silent && until_us > told.at_us) simulator_.feed(until_us, told.channel, *told.value);
}

}  // namespace robosync::tool
