// Serial devices, by libserialport.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "rsc/transport.hpp"

namespace robosync::tool {

[[nodiscard]] std::unique_ptr<Transport> open_serial(const std::string& path);

struct SerialPort {
  std::string name, description;
};
[[nodiscard]] std::vector<SerialPort> list_serial_ports();

}  // namespace robosync::tool
