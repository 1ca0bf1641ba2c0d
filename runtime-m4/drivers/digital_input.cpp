// The level of an input pin: 1 if it is the level that the sensor's wiring calls active, else 0.
//
// Contacts bounce for some milliseconds after they change. Nothing here filters that: if the sampling period is longer
// than the bouncing, at most one sample falls into it, and whichever level that one shows, the
// samples change once. So the descriptors of contacts sample at 50 Hz (stdlib/devices/button.json).
#include "runtime-m4/drivers/drivers.hpp"

namespace robosync::drivers::digital_input {

bool read(boards::Board& board, const vm::Sensor& sensor, const vm::Channel&, std::int32_t& raw) {
  const bool active_high = sensor.bus == static_cast<unsigned>(vm::ActiveLevel::high);
  raw = board.input(sensor.address) == active_high ? 1 : 0;
  return true;
}

}  // namespace robosync::drivers::digital_input
