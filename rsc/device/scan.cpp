// See scan.hpp.
#include "rsc/device/scan.hpp"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "compiler/config/boards.hpp"
#include "compiler/config/devices.hpp"
#include "rsc/names.hpp"
#include "vm/drivers.hpp"

namespace robosync::tool {
namespace {

// Those whose pins select this address, and those that are delivered with it.
std::vector<std::string> devices_at(unsigned address) {
  std::vector<std::string> found;
  for (const compiler::DeviceText& text : compiler::device_texts()) {
    const compiler::Device* device = compiler::find_device(text.name, text.is_sensor);
    if (device == nullptr || !device->has_driver || device->type != "I2C") continue;
    const auto at = static_cast<std::uint16_t>(address);
    const vm::DriverId driver = device->actuator.driver;
    const bool usual = (vm::drives_channel(driver) && at == vm::kFirstChipAddress) ||
                       (vm::drives_screen(driver) && at == vm::kFirstDisplayAddress);
    if (usual || (!device->addresses.empty() && device->can_have(at)))
      found.push_back(device->name);
  }
  return found;
}

FoundPart part_at(const compiler::Board& board, const std::vector<OnBus>& devices, std::uint8_t bus,
                  std::uint8_t address) {
  FoundPart part{.bus = bus, .address = address, .known = {}, .may_be = {}};
  if (const auto* reserved = board.find_reserved(bus, address)) {
    part.known = reserved->used_for;
    return part;
  }
  const auto mine = std::ranges::find_if(devices, [&](const OnBus& device) {
    return !device.spi && device.bus == bus && device.address == address;
  });
  if (mine != devices.end())
    part.known = fmt::format("{} ({})", mine->name, mine->driver);
  else
    part.may_be = devices_at(address);
  return part;
}

}  // namespace

Scan scan_buses(Client& client, const std::string& board, const std::vector<OnBus>& devices) {
  const auto names = compiler::board_names();
  const auto place = std::ranges::find(names, board);
  if (place == names.end()) return {};
  const compiler::Board profile =
      compiler::board_at(static_cast<std::size_t>(place - names.begin()));
  Scan scan{.answers = {}, .held = {}, .buses = profile.i2c_buses};
  for (std::uint8_t bus = 0; bus < profile.i2c_buses; ++bus)
    for (std::uint8_t address = vm::kFirstAddress; address <= vm::kLastAddress; ++address) {
      const link::Probed said = client.probe(bus, address);
      if (said.held != 0) {
        scan.held.push_back(bus);
        break;
      }
      if (said.answers != 0) scan.answers.push_back(part_at(profile, devices, bus, address));
    }
  return scan;
}

std::string scan_text(const Scan& scan) {
  const std::size_t count = scan.answers.size();
  std::string text = fmt::format("scan      {} answer{} on {} I2C bus{}\n", count,
                                 count == 1 ? "" : "s", scan.buses, scan.buses == 1 ? "" : "es");
  for (const FoundPart& part : scan.answers) {
    const std::string what = !part.known.empty() ? part.known
                             : part.may_be.empty()
                                 ? "of no device whose addresses rsc knows"
                                 : fmt::format("may be {}", fmt::join(part.may_be, " or "));
    text += fmt::format("  0x{:02x}    on bus {}: {}\n", part.address, part.bus, what);
  }
  for (const unsigned bus : scan.held)
    text += fmt::format(
        "  held    a line of bus {} is held low, so that nothing on it can answer\n", bus);
  return text;
}

Json scan_json(const Scan& scan) {
  auto list = Json::array();
  for (const FoundPart& part : scan.answers)
    list.push_back({{"bus", part.bus},
                    {"address", fmt::format("0x{:02x}", part.address)},
                    {"known", part.known.empty() ? Json(nullptr) : Json(part.known)},
                    {"may_be", part.may_be}});
  return {{"buses", scan.buses}, {"held", scan.held}, {"answers", list}};
}

}  // namespace robosync::tool
