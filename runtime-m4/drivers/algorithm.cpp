// An algorithm: a module of the firmware computes its channels from another sensor's readings (layers/algorithms.hpp). Never sampled.
#include "runtime-m4/drivers/drivers.hpp"

namespace robosync::drivers::algorithm {

bool read(boards::Board&, const vm::Sensor&, const vm::Channel&, std::int32_t&) {
  return false;
}

}  // namespace robosync::drivers::algorithm
