// See thermometer.hpp. Nordic's nRF52833 Product Specification, TEMP.
#include "runtime-m4/boards/microbit-v2/thermometer.hpp"

#include "runtime-m4/boards/microbit-v2/registers.hpp"

namespace robosync::boards::microbit::thermometer {

bool measure(std::int32_t& raw) {
  const bool is_new = temperature::kIsReady.read() != 0;
  if (is_new) raw = static_cast<std::int32_t>(temperature::kQuarters.read());
  temperature::kStop.write(kDoIt);
  forget(temperature::kIsReady);
  temperature::kStart.write(kDoIt);
  return is_new;
}

}  // namespace robosync::boards::microbit::thermometer
