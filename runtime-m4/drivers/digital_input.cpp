// The level of an input pin: 1 when it is the one that the sensor's wiring calls active, else 0.
//
// Contacts bounce for some milliseconds after they have changed. Nothing here filters that: a sensor that is sampled
// less often than contacts bounce for sees at most one sample amid the bouncing, and whichever level that shows, the
// samples change once. So the descriptors of contacts sample at 50 Hz (stdlib/devices/button.json).
#include "runtime-m4/drivers/drivers.hpp"

namespace robosync::drivers::digital_input {

bool read(boards::Board& board, const vm::Sensor& sensor, const vm::Channel&, std::int32_t& raw) {
  const bool active_high = sensor.bus == static_cast<unsigned>(vm::ActiveLevel::high);
  raw = board.input(sensor.address) == active_high ? 1 : 0;
  return true;
}

}  // namespace robosync::drivers::digital_input
