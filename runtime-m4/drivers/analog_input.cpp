// The voltage of an analog input: a count is a 4095th of the supply's (boards::kAnalogFull). What stands for the supply is what the
// board measures with, so a divider between 3.3 V and GND reads the same whatever the supply does.
#include "runtime-m4/drivers/drivers.hpp"

namespace robosync::drivers::analog_input {

bool read(boards::Board& board, const vm::Sensor& sensor, const vm::Channel&, std::int32_t& raw) {
  std::uint16_t voltage = 0;
  if (!board.analog(sensor.address, voltage)) return false;
  raw = voltage;
  return true;
}

}  // namespace robosync::drivers::analog_input
