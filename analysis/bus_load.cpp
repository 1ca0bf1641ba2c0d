// See bus_load.hpp.
#include "analysis/bus_load.hpp"

#include <algorithm>

#include "runtime-m4/policy/rules.hpp"

namespace robosync::analysis {
namespace {

// A sensor whose period is shorter than the window is asked several times in it.
std::uint32_t times_in_window(const vm::Sensor& sensor, std::uint32_t window_us) {
  const std::uint32_t period_us = std::max<std::uint32_t>(sensor.period_ms, 1) * 1000;
  return (window_us + period_us - 1) / period_us;
}

constexpr std::uint32_t kTickUs = 1000;

// How long it may take until the bus is there for sensors.
std::uint32_t take_us(const vm::Sensor& sensor, const policy::BoardCosts& board) {
  if (vm::is_on_spi(sensor.driver)) return 0;
  return board.i2c_take_us;
}

}  // namespace

std::uint32_t answered_in_us(const vm::Image& image, const policy::BoardCosts& board,
                             const vm::Sensor& sensor) {
  const std::uint32_t window_us = policy::bus_window_us(board.bus_ahead_ms);
  std::uint32_t us = policy::kBeforeBusUs + take_us(sensor, board) + kTickUs;
  for (const vm::Sensor& other : image.sensors)
    if (other.bus == sensor.bus && vm::is_on_spi(other.driver) == vm::is_on_spi(sensor.driver))
      us += policy::bus_us(other, board) * times_in_window(other, window_us);
  return std::clamp(us, board.bus_ahead_ms * kTickUs, window_us + policy::kBeforeBusUs);
}

std::vector<BusLoad> overloaded_buses(const vm::Image& image, const policy::BoardCosts& board) {
  const std::uint32_t window_us = policy::bus_window_us(board.bus_ahead_ms);
  std::vector<BusLoad> loads;
  for (unsigned s = 0; s < image.sensors.size(); ++s) {
    const vm::Sensor& sensor = image.sensors[s];
    const std::uint32_t us = policy::bus_us(sensor, board) * times_in_window(sensor, window_us);
    if (us == 0) continue;
    const bool spi = vm::is_on_spi(sensor.driver);
    auto load = std::ranges::find_if(
        loads, [&](const BusLoad& one) { return one.bus == sensor.bus && one.spi == spi; });
    if (load == loads.end())
      load = loads.insert(
          loads.end(),
          BusLoad{.bus = sensor.bus, .spi = spi, .window_us = window_us - take_us(sensor, board)});
    load->us += us;
    load->shares.push_back({s, us});
  }
  std::erase_if(loads, [](const BusLoad& load) { return load.us <= load.window_us; });
  return loads;
}

}  // namespace robosync::analysis
