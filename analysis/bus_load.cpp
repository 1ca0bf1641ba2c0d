// See bus_load.hpp.
#include "analysis/bus_load.hpp"

#include <algorithm>

#include "runtime-m4/policy/rules.hpp"

namespace robosync::analysis {
namespace {

// A sensor whose period is shorter than the window is asked several times in it.
std::uint32_t times_in_window(const vm::Sensor& sensor) {
  const std::uint32_t period_us = std::max<std::uint32_t>(sensor.period_ms, 1) * 1000;
  return (policy::kBusWindowUs + period_us - 1) / period_us;
}

}  // namespace

std::vector<BusLoad> overloaded_buses(const vm::Image& image, const policy::BoardCosts& board) {
  std::vector<BusLoad> loads;
  for (unsigned s = 0; s < image.sensors.size(); ++s) {
    const vm::Sensor& sensor = image.sensors[s];
    const std::uint32_t us = policy::bus_us(sensor, board) * times_in_window(sensor);
    if (us == 0) continue;
    const bool spi = vm::is_on_spi(sensor.driver);
    auto load = std::ranges::find_if(
        loads, [&](const BusLoad& one) { return one.bus == sensor.bus && one.spi == spi; });
    if (load == loads.end())
      load = loads.insert(loads.end(), BusLoad{.bus = sensor.bus, .spi = spi});
    load->us += us;
    load->shares.push_back({s, us});
  }
  std::erase_if(loads, [](const BusLoad& load) { return load.us <= policy::kBusWindowUs; });
  return loads;
}

}  // namespace robosync::analysis
