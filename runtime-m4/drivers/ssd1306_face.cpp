// A face on an SSD1306: it shows what the lights of a board would. screen.hpp decides what the display is
// told, and when.
#include "runtime-m4/drivers/drivers.hpp"

namespace robosync::drivers::ssd1306_face {

kernel::Time start(const Device& device, const Order& order, kernel::Time now) {
  return lights::start(device, order, now);
}

kernel::Time advance(const Device& device, kernel::Time now) {
  return lights::advance(device, now);
}

void release(const Device& device, vm::Release how, kernel::Time now) {
  lights::release(device, how, now);
}

}  // namespace robosync::drivers::ssd1306_face
