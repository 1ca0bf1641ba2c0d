// See devices.hpp. The board's data is not trusted.
#include "rsc/device/devices.hpp"

#include <algorithm>
#include <chrono>

#include <fmt/format.h>

#include "rsc/json.hpp"
#include "rsc/names.hpp"
#include "runtime-m4/policy/threads.hpp"
#include "vm/drivers.hpp"

namespace robosync::tool {
namespace {

using std::chrono::milliseconds;

// Sensors are measured as soon as the program starts.
constexpr milliseconds kFirstRound{1000};

bool has(std::uint32_t mask, std::size_t bit) {
  return bit < 32 && (mask >> bit & 1) != 0;
}

std::string name_of(const vm::Image& image, std::size_t sensor) {
  const std::string_view name = image.string(image.sensors[sensor].name);
  return name.empty() ? fmt::format("sensor {}", sensor) : std::string(name);
}

}  // namespace

std::vector<OnBus> on_buses(const vm::Image& image, const link::Devices& said) {
  std::vector<OnBus> found;
  found.reserve(image.sensors.size());
  for (std::size_t s = 0; s < image.sensors.size(); ++s) {
    const vm::Sensor& sensor = image.sensors[s];
    const bool spi = vm::is_on_spi(sensor.driver);
    if (policy::is_fed(sensor) || !(spi || vm::is_on_i2c(sensor.driver))) continue;
    found.push_back({.name = name_of(image, s),
                     .driver = driver_name(sensor.driver),
                     .bus = sensor.bus,
                     .address = sensor.address,
                     .spi = spi,
                     .asked = has(said.asked, s),
                     .silent = has(said.silent, s),
                     .held = !spi && has(said.held, sensor.bus),
                     .failed = s < said.failed.size() ? said.failed.at(s) : 0U});
  }
  return found;
}

std::vector<OnBus> silent_after_start(Client& client, const vm::Image& image) {
  std::vector<OnBus> devices = on_buses(image, {});
  const auto give_up = client.now() + kFirstRound + milliseconds(image.header->safety_start_ms);
  while (!std::ranges::all_of(devices, &OnBus::asked) && client.now() < give_up)
    devices = on_buses(image, client.devices());
  std::erase_if(devices, [](const OnBus& device) { return !device.silent; });
  return devices;
}

std::string found_text(const OnBus& device) {
  std::string text = name_on_bus(fmt::format("{} ({})", device.name, device.driver), device.address,
                                 device.bus, device.spi);
  text += !device.asked ? " has not been asked yet" : device.spi ? " is read" : " answers";
  if (device.failed != 0)
    text += fmt::format("; {} transfer{} failed", device.failed, device.failed == 1 ? "" : "s");
  return text;
}

std::string silent_text(const OnBus& device) {
  const char* const look =
      device.held ? "a line of that bus is held low: do two wires touch, and does every device on "
                    "it have power?"
      : device.spi
          ? "does it have power, are the wires of the bus and its select pin connected?"
          : "does it have power, are both wires of the bus connected, is this its address?";
  return fmt::format("{} does not answer ({} transfer{} failed): {}",
                     name_on_bus(device.name, device.address, device.bus, device.spi),
                     device.failed, device.failed == 1 ? "" : "s", look);
}

Json devices_json(const std::vector<OnBus>& devices) {
  auto list = Json::array();
  for (const OnBus& device : devices)
    list.push_back(
        {{"sensor", device.name},
         {"driver", device.driver},
         {"bus", device.bus},
         {device.spi ? "pin" : "address",
          device.spi ? Json(device.address) : Json(fmt::format("0x{:02x}", device.address))},
         {"answers", device.asked ? Json(!device.silent) : nullptr},
         {"bus_held", device.held},
         {"failed", device.failed}});
  return list;
}

}  // namespace robosync::tool
