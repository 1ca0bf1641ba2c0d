// A sound player: a track plays for FOR, one second when its length is not given. The board
// interface has no line to a player module yet, so what is real here is the time a track occupies
// the player, and that it can be cut short; the track's number is seen in the trace.
#include "runtime-m4/drivers/timed.hpp"

namespace robosync::drivers::player {

kernel::Time start(const Device& device, const Order& order, kernel::Time now) {
  return take_time(device, order, now);
}

kernel::Time advance(const Device& device, kernel::Time now) {
  return go_on(device, now);
}

void release(const Device&, vm::Release, kernel::Time) {}

}  // namespace robosync::drivers::player
