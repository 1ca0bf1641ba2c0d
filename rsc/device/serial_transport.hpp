// Serial devices, by libserialport.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "rsc/device/transport.hpp"

namespace robosync::tool {

inline constexpr int kBaudRate = 115200;

[[nodiscard]] std::unique_ptr<Transport> open_serial(const std::string& path, Sharing sharing);

struct SerialPort {
  std::string name, description;
  std::string usb;  // "0483:374b", vendor and product; empty when it is not on USB
};
[[nodiscard]] std::vector<SerialPort> list_serial_ports();

}  // namespace robosync::tool
