// A virtual actuator that takes what the real one would: power on a pin, a picture, or tones
// (vm::VirtualOutput says which). Its commands are seen in the trace. Most are done as soon as they
// begin, like those of the real ones.
#include <cstdint>
#include <initializer_list>
#include <iterator>
#include <numeric>

#include "runtime-m4/drivers/blink.hpp"
#include "runtime-m4/drivers/timed.hpp"

namespace robosync::drivers::virtual_output {
namespace {

constexpr std::uint32_t length_of(std::initializer_list<std::uint32_t> notes) {
  return std::accumulate(notes.begin(), notes.end(), 0U);
}

// In milliseconds.
constexpr std::uint32_t kMelodies[] = {
#define NOTE(hertz, milliseconds) milliseconds,
#define MELODY(name, notes) length_of({notes}),
#include "runtime-m4/drivers/melodies.def"
#undef MELODY
#undef NOTE
};

kernel::Duration said(const Order& order, vm::Param param) {
  return duration_of(order.get(param, 0));
}

kernel::Duration shown(const Order& order) {
  return said(order, vm::Param::over) + said(order, vm::Param::for_);
}

kernel::Duration picture(const Order& order) {
  if (order.action != vm::Action::play) return shown(order);
  const Blink blink = blink_of(order);
  return blink.legs * blink.leg;
}

kernel::Duration tune(const Order& order) {
  if (order.has(vm::Param::for_)) return said(order, vm::Param::for_);
  if (order.has(vm::Param::at) && !order.has(vm::Param::item)) return kDefaultDuration;
  const auto melody = static_cast<std::uint32_t>(order.get(vm::Param::item, 0) / vm::kScale);
  return kernel::milliseconds(kMelodies[melody < std::size(kMelodies) ? melody : 0]);
}

kernel::Duration length_of(const Device& device, const Order& order) {
  if (order.action == vm::Action::stop) return 0;
  switch (static_cast<vm::VirtualOutput>(device.wiring.bus)) {
    case vm::VirtualOutput::picture:
      return picture(order);
    case vm::VirtualOutput::tones:
      return tune(order);
    default:
      return shown(order);
  }
}

}  // namespace

kernel::Time start(const Device& device, const Order& order, kernel::Time now) {
  const kernel::Duration length = length_of(device, order);
  if (length == 0) return kDone;
  device.state.until = now + length;
  return device.state.until;
}

kernel::Time advance(const Device& device, kernel::Time now) {
  return go_on(device, now);
}

void release(const Device&, vm::Release, kernel::Time) {}

}  // namespace robosync::drivers::virtual_output
