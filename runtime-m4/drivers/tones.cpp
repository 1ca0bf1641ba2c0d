// Melodies and tones on the board's speaker. PLAY plays a melody to its end, or with FOR repeats it for that long; with
// AT and no melody it plays one tone, for FOR or else for a second. Whatever ends it, it is silent afterwards.
#include <cstdint>
#include <iterator>
#include <span>

#include "runtime-m4/drivers/timed.hpp"

namespace robosync::drivers::tones {
namespace {

struct Note {
  std::uint16_t hertz, milliseconds;
};

namespace melodies {
#define NOTE(hertz, milliseconds) {hertz, milliseconds},
#define MELODY(name, notes) constexpr Note name[] = {notes};
#include "runtime-m4/drivers/melodies.def"
#undef MELODY
#undef NOTE
}  // namespace melodies

constexpr std::span<const Note> kMelodies[] = {
#define MELODY(name, ...) melodies::name,
#include "runtime-m4/drivers/melodies.def"
#undef MELODY
};

constexpr vm::Value kLowest = 50, kHighest = 10'000;  // Hz

// In the actuator's state, `home` is the melody, `legs` the number of notes left, `until` the end of the current sound, and the
// motion's `begin` the end of the whole order, or 0 if that is the melody's end.
kernel::Time end_of_all(const Device& device) {
  return device.state.motion.begin;
}

kernel::Time sound_until(const Device& device, std::uint32_t hertz, kernel::Time until) {
  const kernel::Time end = end_of_all(device);
  device.state.until = end != 0 ? std::min(until, end) : until;
  device.sound(hertz);
  return device.state.until;
}

kernel::Time next_note(const Device& device, kernel::Time now) {
  const std::span<const Note> melody = kMelodies[static_cast<std::size_t>(device.state.home)];
  const Note& note = melody[melody.size() - device.state.legs];
  --device.state.legs;
  return sound_until(device, note.hertz, now + kernel::milliseconds(note.milliseconds));
}

kernel::Time from_the_front(const Device& device, kernel::Time now) {
  device.state.legs =
      static_cast<std::uint16_t>(kMelodies[static_cast<std::size_t>(device.state.home)].size());
  return next_note(device, now);
}

}  // namespace

kernel::Time start(const Device& device, const Order& order, kernel::Time now) {
  release(device, vm::Release::rest, now);
  if (order.action == vm::Action::stop) return kDone;
  const kernel::Duration length = duration_of(order.get(vm::Param::for_, 0));
  if (order.has(vm::Param::for_) && length == 0) return kDone;
  device.state.motion.begin = length == 0 ? 0 : now + length;
  if (order.has(vm::Param::at) && !order.has(vm::Param::item)) {
    const vm::Value hertz = std::clamp(order.get(vm::Param::at, 0) / vm::kScale, kLowest, kHighest);
    if (length == 0) device.state.motion.begin = now + kDefaultDuration;
    return sound_until(device, static_cast<std::uint32_t>(hertz), end_of_all(device));
  }
  const auto melody = static_cast<std::uint32_t>(order.get(vm::Param::item, 0) / vm::kScale);
  device.state.home = melody < std::size(kMelodies) ? static_cast<vm::Value>(melody) : 0;
  device.state.placed = true;  // it is a melody
  return from_the_front(device, now);
}

kernel::Time advance(const Device& device, kernel::Time now) {
  if (now < device.state.until) return device.state.until;
  const kernel::Time end = end_of_all(device);
  const bool over = end != 0 && now >= end;
  if (!over && device.state.legs > 0) return next_note(device, now);
  if (!over && end != 0 && device.state.placed) return from_the_front(device, now);
  release(device, vm::Release::rest, now);
  return kDone;
}

// A tone cannot be held.
void release(const Device& device, vm::Release, kernel::Time) {
  device.state.legs = 0;
  device.state.placed = false;
  device.state.motion.begin = 0;
  device.sound(0);
}

}  // namespace robosync::drivers::tones
