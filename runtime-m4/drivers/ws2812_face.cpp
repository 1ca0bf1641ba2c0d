// A face on a WS2812 panel: it shows what the lights of a board would. The board knows where the panel's lights are, and what
// they are told.
#include "runtime-m4/drivers/drivers.hpp"

namespace robosync::drivers::ws2812_face {

kernel::Time start(const Device& device, const Order& order, kernel::Time now) {
  return lights::start(device, order, now);
}

kernel::Time advance(const Device& device, kernel::Time now) {
  return lights::advance(device, now);
}

void release(const Device& device, vm::Release how, kernel::Time now) {
  lights::release(device, how, now);
}

}  // namespace robosync::drivers::ws2812_face
