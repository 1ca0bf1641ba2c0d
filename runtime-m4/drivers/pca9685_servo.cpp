// A hobby servo on a channel of a PCA9685: it moves like one on a pin. servo_chip.hpp decides what the chip is
// told, and when.
#include "runtime-m4/drivers/drivers.hpp"

namespace robosync::drivers::pca9685_servo {

kernel::Time start(const Device& device, const Order& order, kernel::Time now) {
  device.begin_order();
  return servo::start(device, order, now);
}

kernel::Time advance(const Device& device, kernel::Time now) {
  return servo::advance(device, now);
}

void release(const Device& device, vm::Release how, kernel::Time now) {
  servo::release(device, how, now);
}

}  // namespace robosync::drivers::pca9685_servo
