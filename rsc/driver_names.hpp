// Names of drivers, as they stand in vm/drivers.def.
#pragma once

#include <array>
#include <string_view>

#include "vm/image.hpp"

namespace robosync::tool {

[[nodiscard]] constexpr std::string_view driver_name(vm::DriverId driver) {
  constexpr std::array<std::string_view, static_cast<std::size_t>(vm::DriverId::count_)> kNames = {
#define SENSOR_DRIVER(name, doc) #name,
#define ACTUATOR_DRIVER(name, doc) #name,
#include "vm/drivers.def"
#undef SENSOR_DRIVER
#undef ACTUATOR_DRIVER
  };
  const auto index = static_cast<std::size_t>(driver);
  return index < kNames.size() ? kNames[index] : "unknown";
}

}  // namespace robosync::tool
