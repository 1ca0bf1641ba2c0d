// A virtual actuator: its commands are seen in the trace. It takes as long as FOR or OVER says, or one
// second if neither is given.
#include "runtime-m4/drivers/timed.hpp"

namespace robosync::drivers::virtual_actuator {

kernel::Time start(const Device& device, const Order& order, kernel::Time now) {
  return take_time(device, order, now);
}

kernel::Time advance(const Device& device, kernel::Time now) {
  return go_on(device, now);
}

void release(const Device&, vm::Release, kernel::Time) {}

}  // namespace robosync::drivers::virtual_actuator
