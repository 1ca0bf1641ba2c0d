// complete_configuration().
#include "compiler/query/configuration.hpp"

#include <set>
#include <string_view>

#include "compiler/config/boards.hpp"
#include "compiler/config/devices.hpp"
#include "compiler/config/fields.hpp"
#include "compiler/config/wiring.hpp"
#include "compiler/query/configuration_scan.hpp"

namespace robosync::compiler::query {
namespace {

void add(Completion& completion, std::string_view text) {
  completion.candidates.push_back(
      {.text = std::string(text), .kind = {}, .detail = {}, .text_about = {}, .is_text = true});
}

void add_keys(Completion& completion, Object object, const std::set<std::string_view>& present) {
  for (const Key& key : known_keys())
    if (key.object == object && key.use == KeyUse::used && !present.contains(key.name))
      add(completion, key.name);
}

void add_values(Completion& completion, Object object, std::string_view key) {
  const bool sensor = object == Object::sensor;
  if (object == Object::robot && key == "board")
    for (const std::string_view name : board_names())
      add(completion, name);
  if (!sensor && object != Object::actuator) return;
  if (key == "device")
    for (const DeviceText& device : device_texts())
      if (device.is_sensor == sensor) add(completion, device.name);
  if (key == "type")
    for (const WiringType& type : wiring_types())
      if (sensor ? type.for_sensors : type.for_actuators) add(completion, type.name);
}

}  // namespace

Completion complete_configuration(const SourceFile& source, FileId file, std::uint32_t offset) {
  Scan scan(source.text(), offset);
  scan.run();
  Completion completion;
  completion.typed = {file, static_cast<std::uint32_t>(scan.begin()),
                      static_cast<std::uint32_t>(scan.end())};
  const Spot& spot = scan.spot();
  if (spot.is_list || !spot.shape.itself) return completion;
  if (spot.at_key)
    add_keys(completion, *spot.shape.itself, scan.keys());
  else
    add_values(completion, *spot.shape.itself, spot.key);
  return completion;
}

}  // namespace robosync::compiler::query
