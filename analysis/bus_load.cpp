// See bus_load.hpp.
#include "analysis/bus_load.hpp"

#include <algorithm>
#include <functional>
#include <map>
#include <utility>

#include "runtime-m4/policy/rules.hpp"

namespace robosync::analysis {
namespace {

// Who is read more often than the window is long is asked several times in it.
std::uint32_t times_in_window(const vm::Sensor& sensor) {
  const std::uint32_t period_us = std::max<std::uint32_t>(sensor.period_ms, 1) * 1000;
  return (policy::kBusWindowUs + period_us - 1) / period_us;
}

}  // namespace

std::vector<BusLoad> overloaded_buses(const vm::Image& image, const policy::BoardCosts& board) {
  std::map<std::uint8_t, BusLoad> loads;
  for (unsigned s = 0; s < image.sensors.size(); ++s) {
    const vm::Sensor& sensor = image.sensors[s];
    const std::uint32_t us = policy::bus_us(sensor, board) * times_in_window(sensor);
    if (us == 0) continue;
    BusLoad& load = loads[sensor.bus];
    load.bus = sensor.bus;
    load.us += us;
    load.shares.push_back({s, us});
  }
  std::vector<BusLoad> overloaded;
  for (auto& [bus, load] : loads) {
    if (load.us <= policy::kBusWindowUs) continue;
    std::ranges::stable_sort(load.shares, std::greater(), &BusLoad::Share::us);
    overloaded.push_back(std::move(load));
  }
  return overloaded;
}

}  // namespace robosync::analysis
