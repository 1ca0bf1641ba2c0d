// A picture on the board's lights. SHOW shows one, or a number, which stays; with FOR it goes dark afterwards. BLINK closes
// the eyes of the picture shown: TIMES blinks, all within OVER.
#include "runtime-m4/drivers/blink.hpp"
#include "runtime-m4/drivers/pictures.hpp"
#include "runtime-m4/drivers/timed.hpp"

namespace robosync::drivers::lights {
namespace {

Picture picture_of(const Order& order) {
  return order.has(vm::Param::to) ? number_picture(order.get(vm::Param::to, 0))
                                  : named_picture(order.get(vm::Param::item, 0));
}

// A leg is over. The first leg is dark, the last one lit.
kernel::Time next_leg(const Device& device, kernel::Time now) {
  if (--device.state.legs == 0) return kDone;
  const bool dark = device.state.legs % 2 == 0;
  device.show(dark ? 0 : static_cast<std::uint32_t>(device.state.home));
  device.state.until = now + static_cast<kernel::Duration>(device.state.speed);
  return device.state.until;
}

kernel::Time blink(const Device& device, const Order& order, kernel::Time now) {
  const Blink blink = blink_of(order);
  device.state.speed = static_cast<vm::Value>(blink.leg);
  device.state.legs = static_cast<std::uint16_t>(blink.legs);
  device.state.until = now + blink.leg;
  device.show(0);
  return device.state.until;
}

}  // namespace

kernel::Time start(const Device& device, const Order& order, kernel::Time now) {
  device.state.legs = 0;
  if (order.action == vm::Action::play) return blink(device, order, now);
  const bool shows = order.action == vm::Action::set;
  device.state.home = static_cast<vm::Value>(shows ? picture_of(order) : 0);
  device.show(static_cast<std::uint32_t>(device.state.home));
  if (!shows || !order.has(vm::Param::for_)) return kDone;
  return take_time(device, order, now);
}

kernel::Time advance(const Device& device, kernel::Time now) {
  if (now < device.state.until) return device.state.until;
  if (device.state.legs > 0) return next_leg(device, now);
  release(device, vm::Release::rest, now);
  return kDone;
}

// hold keeps the picture, also in the middle of a blink.
void release(const Device& device, vm::Release how, kernel::Time) {
  device.state.legs = 0;
  if (how != vm::Release::hold) device.state.home = 0;
  device.show(static_cast<std::uint32_t>(device.state.home));
}

}  // namespace robosync::drivers::lights
