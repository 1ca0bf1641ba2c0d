// The voltage of an analog input, in 4095ths of the supply (boards::kAnalogFull). The board measures against its supply,
// so a divider between 3.3 V and GND reads the same whatever the supply does.
#include "runtime-m4/drivers/drivers.hpp"

namespace robosync::drivers::analog_input {

bool read(boards::Board& board, const vm::Sensor& sensor, const vm::Channel&, std::int32_t& raw) {
  std::uint16_t voltage = 0;
  if (!board.analog(sensor.address, voltage)) return false;
  raw = voltage;
  return true;
}

}  // namespace robosync::drivers::analog_input
