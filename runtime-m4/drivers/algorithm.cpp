// What a module of the firmware computes from another sensor's readings (layers/algorithms.hpp): never sampled.
#include "runtime-m4/drivers/drivers.hpp"

namespace robosync::drivers::algorithm {

bool read(boards::Board&, const vm::Sensor&, const vm::Channel&, std::int32_t&) {
  return false;
}

}  // namespace robosync::drivers::algorithm
