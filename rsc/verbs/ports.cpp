// rsc ports [--format human|json]
#include <iostream>
#include <memory>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "rsc/console.hpp"
#include "rsc/device/serial_transport.hpp"
#include "rsc/verb.hpp"
#include "rsc/verb_options.hpp"

namespace robosync::tool {
namespace {

void ports(Format format) {
  const std::vector<SerialPort> found = list_serial_ports();
  if (format == Format::json) {
    auto list = nlohmann::ordered_json::array();
    for (const SerialPort& port : found)
      list.push_back({{"port", port.name}, {"description", port.description}});
    std::cout << list.dump() << '\n';
    return;
  }
  for (const SerialPort& port : found)
    std::cout << fmt::format("{:<20}  {}\n", port.name, port.description);
  if (found.empty()) {
    std::cerr << "rsc: no serial ports found; is the board plugged in? (`scripts/robot` starts an "
                 "emulated one)\n";
  }
}

}  // namespace

void add_ports(Options& options) {
  auto format = std::make_shared<Format>(Format::human);
  add_format_option(options, *format);
  options.runs([format] { ports(*format); });
}

}  // namespace robosync::tool
