// See performance.hpp.
#include "runtime-m4/layers/performance.hpp"

#include <algorithm>

#include "runtime-m4/policy/rules.hpp"

namespace robosync::layers {

using vm::Param;

namespace {

static_assert(vm::kMinKeyGapMs == policy::kSetpointPeriodMs);

constexpr vm::Value kAsWritten = 100 * vm::kScale;  // percent
constexpr vm::Value kMostRounds = 1000;

// The track of `actuator`, or nullptr.
const vm::Track* find_track(const vm::Image& image, std::size_t motion, unsigned actuator) {
  if (motion >= image.motions.size()) return nullptr;
  const vm::Motion& played = image.motions[motion];
  for (const vm::Track& track : image.tracks.subspan(played.first_track, played.track_count))
    if (track.actuator == actuator) return &track;
  return nullptr;
}

}  // namespace

void Performance::begin(const vm::Image& image, unsigned actuator, const drivers::Order& order,
                        kernel::Time now) {
  end();
  const vm::Value item = order.get(Param::item, -1);
  const vm::Value times = order.get(Param::times, vm::kScale);
  tempo_ = order.get(Param::at, kAsWritten);
  if (item < 0 || times < vm::kScale || tempo_ <= 0) return;  // kUnknown is below 0
  const auto motion = static_cast<std::size_t>(item / vm::kScale);
  const vm::Track* const track = find_track(image, motion, actuator);
  if (track == nullptr) return;
  first_key_ = track->first_key;
  keys_ = track->key_count;
  next_key_ = 0;
  rounds_ = static_cast<std::uint16_t>(std::min(times / vm::kScale, kMostRounds));
  round_ = now;
  length_ = stretched(image.motions[motion].length);
}

bool Performance::next(const vm::Image& image, kernel::Time now, drivers::Order& order) {
  if (next_key_ == keys_) {
    if (rounds_ <= 1) return false;
    --rounds_;
    round_ += length_;
    next_key_ = 0;
  }
  const vm::Key& key = image.keys[first_key_ + std::size_t{next_key_}];
  ++next_key_;
  const kernel::Time due = round_ + stretched(key.time);
  const kernel::Duration gap = kernel::milliseconds(vm::kMinKeyGapMs);
  const kernel::Duration left = due > now + gap ? due - now : gap;
  order.action = vm::Action::move;
  order.given = bit<unsigned>(static_cast<unsigned>(Param::to)) |
                bit<unsigned>(static_cast<unsigned>(Param::over));
  order[Param::to] = key.to;
  order[Param::over] =
      static_cast<vm::Value>(std::min<kernel::Duration>(left / 1000, vm::kValueMax));
  return true;
}

// How long `time` takes at the tempo, in whole milliseconds; at 200 % it is halved.
kernel::Duration Performance::stretched(vm::Value time) const {
  const std::uint64_t milliseconds = static_cast<std::uint64_t>(time) *
                                     static_cast<std::uint64_t>(kAsWritten) /
                                     static_cast<std::uint64_t>(tempo_);
  return milliseconds * 1000;
}

}  // namespace robosync::layers
