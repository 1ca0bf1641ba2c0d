// A virtual sensor: its readings are fed over the link or by a scenario, never sampled.
#include "runtime-m4/drivers/drivers.hpp"

namespace robosync::drivers::virtual_sensor {

bool read(boards::Board&, const vm::Sensor&, const vm::Channel&, std::int32_t&) {
  return false;
}

}  // namespace robosync::drivers::virtual_sensor
