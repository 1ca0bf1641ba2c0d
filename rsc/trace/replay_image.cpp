// See replay_image.hpp.
#include "rsc/trace/replay_image.hpp"

#include <algorithm>
#include <cstring>
#include <optional>
#include <span>

#include <fmt/format.h>

#include "rsc/json.hpp"
#include "rsc/trace/replay_event.hpp"
#include "vm/drive.hpp"
#include "vm/drivers.hpp"
#include "vm/identity.hpp"
#include "vm/verifier.hpp"

namespace robosync::tool {
namespace {

// The record at `index` of a section, in the bytes behind the image.
template <typename Record, typename How>
void change(std::vector<std::byte>& bytes, std::span<const Record> section, std::size_t index,
            const How& how) {
  const auto* const at = reinterpret_cast<const std::byte*>(&section[index]);
  std::byte* const to = bytes.data() + (at - bytes.data());
  Record record;
  std::memcpy(&record, to, sizeof record);
  how(record);
  std::memcpy(to, &record, sizeof record);
}

// A variable's value as in the trace; nothing if it is not one of its values.
std::optional<vm::Value> value_of(const vm::Image& image, const vm::Variable& variable,
                                  const Json& value) {
  if (value.is_number())
    return static_cast<vm::Value>(
        std::clamp<double>(thousandths_of(value), variable.min, variable.max));
  for (unsigned label = 0; label < variable.label_count; ++label)
    if (value == image.string(image.labels[variable.first_label + label]))
      return static_cast<vm::Value>(label) * vm::kScale;
  return std::nullopt;
}

// An image of `rsc run` has the KEPT numbers that the run began with, as the robot has those of its store: what the program
// declares does not count.
void begin_as_kept(std::vector<std::byte>& bytes, const vm::Image& image,
                   std::span<const std::byte> recorded) {
  vm::Image before;
  if (!vm::verify(recorded, vm::Limits{}, before).ok()) return;
  const auto is_kept = [](const vm::Variable& one) { return one.kind == vm::VariableKind::kept; };
  for (const vm::Variable& old : before.variables)
    for (std::size_t i = 0; i < image.variables.size(); ++i)
      if (is_kept(old) && is_kept(image.variables[i]) &&
          image.string(image.variables[i].name) == before.string(old.name))
        change(bytes, image.variables, i, [&old](vm::Variable& variable) {
          if (variable.dimension == old.dimension)
            variable.initial = std::clamp(old.initial, variable.min, variable.max);
        });
}

// Is it an encoder that a drive goes by? The image may be damaged.
bool is_of_drive(const vm::Image& image, std::size_t sensor) {
  return std::ranges::any_of(image.actuators, [&](const vm::Actuator& one) {
    if (!vm::drives_wheels(one.driver) || one.pin + vm::kDriveValues > image.constants.size())
      return false;
    const auto encoders = vm::drive_of(image.constants.data() + one.pin).encoders;
    return std::ranges::find(encoders, sensor + 1) != encoders.end();
  });
}

}  // namespace

std::vector<std::byte> with_fed_sensors(std::vector<std::byte> bytes) {
  vm::Image image;
  if (!vm::view_image(bytes, image) || !vm::is_named(bytes, {})) return bytes;
  for (std::size_t i = 0; i < image.sensors.size(); ++i) {
    if (is_of_drive(image, i)) continue;
    change(bytes, image.sensors, i, [](vm::Sensor& sensor) {
      if (vm::is_served(sensor.driver)) return;
      sensor.driver = vm::DriverId::virtual_sensor;
      sensor.period_ms = 0;
      sensor.first_input = 0;
      sensor.room = 0;
    });
  }
  vm::seal(bytes);
  return bytes;
}

std::vector<std::byte> with_plain_channels(const Program& program,
                                           const std::set<std::uint8_t>& silent) {
  std::vector<std::byte> bytes(program.bytes().begin(), program.bytes().end());
  vm::Image image;
  if (!vm::view_image(bytes, image)) return bytes;
  for (std::size_t i = 0; i < image.channels.size(); ++i) {
    change(bytes, image.channels, i, [](vm::Channel& channel) { channel.change = 0; });
    if (!silent.contains(static_cast<std::uint8_t>(i)))
      change(bytes, image.channels, i, [](vm::Channel& channel) { channel.stale_ms = 0; });
  }
  vm::seal(bytes);
  return bytes;
}

std::vector<std::byte> with_beginnings(std::vector<std::byte> bytes,
                                       const RecordedProgram& recorded) {
  vm::Image image;
  if (!vm::view_image(bytes, image)) return bytes;
  begin_as_kept(bytes, image, recorded.image);
  for (const auto& [line, event] : recorded.events) {
    if (!is_beginning(event)) continue;
    for (std::size_t i = 0; i < image.variables.size(); ++i) {
      if (image.string(image.variables[i].name) != event.value("variable", "")) continue;
      const auto value = value_of(image, image.variables[i], event.value("value", Json(nullptr)));
      if (value)
        change(bytes, image.variables, i,
               [&value](vm::Variable& variable) { variable.initial = *value; });
    }
  }
  vm::seal(bytes);
  return bytes;
}

std::vector<std::string> unrecorded(const RecordedProgram& recorded, const vm::Image& image) {
  vm::Image before;
  std::vector<std::string> names;
  if (!vm::verify(recorded.image, vm::Limits{}, before).ok()) return names;
  const auto name = [](const vm::Image& of, const vm::Channel& channel) {
    return fmt::format("{}.{}", of.string(of.sensors[channel.sensor].name),
                       of.string(channel.name));
  };
  for (const vm::Channel& channel : image.channels) {
    const std::string wanted = name(image, channel);
    const auto is_it = [&](const vm::Channel& other) { return name(before, other) == wanted; };
    if (std::ranges::none_of(before.channels, is_it)) names.push_back(wanted);
  }
  return names;
}

}  // namespace robosync::tool
