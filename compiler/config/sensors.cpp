// One entry of "sensors".
#include <algorithm>

#include "compiler/config/channels.hpp"
#include "compiler/config/entries.hpp"
#include "compiler/config/values.hpp"
#include "vm/drivers.hpp"

namespace robosync::compiler {
namespace {

// The descriptor's channel of this name, else its first as the pattern for a new one.
ChannelConfig pattern_for(const Device& device, const json::Member& member) {
  const auto& known = device.sensor.channels;
  const auto same = std::find_if(known.begin(), known.end(), [&](const ChannelConfig& channel) {
    return same_name(channel.name.text, member.key);
  });
  ChannelConfig channel = same == known.end() ? known.front() : *same;
  channel.name = {member.key, member.key_span};
  channel.unit_span = member.key_span;
  return channel;
}

void check_channel_names(const std::vector<ChannelConfig>& channels, Diagnostics& diagnostics) {
  const NameIndex places = index_of(channels);
  for (const ChannelConfig& channel : channels) {
    check_name(channel.name, diagnostics);
    const Spelled& first = channels[*places.find(channel.name.text)].name;
    if (first.text != channel.name.text)
      diagnostics
          .report(Code::E0101, channel.name.shown() + " and `" + first.text + "` are the same name")
          .label(channel.name.span)
          .label(first.span, "first given here", false);
  }
}

void read_channels(const json::Value& value, const Device& device, SensorConfig& sensor,
                   Diagnostics& diagnostics) {
  if (!expect_kind(value, json::Kind::object, diagnostics)) return;
  report_repeated_keys(value, diagnostics);
  if (value.members.empty()) {
    diagnostics.report(Code::E0205, "a sensor has at least one channel").label(value.span);
    return;
  }
  sensor.channels.clear();
  for (const json::Member& member : value.members) {
    ChannelConfig channel = pattern_for(device, member);
    read_channel(member.value, device.inputs, channel, diagnostics);
    sensor.channels.push_back(std::move(channel));
  }
  check_channel_names(sensor.channels, diagnostics);
}

// What is fed is not sampled: it has no period, and is stale only if robot.json says so.
void make_fed(SensorConfig& sensor, const json::Value* channels, Diagnostics& diagnostics) {
  sensor.driver = vm::DriverId::virtual_sensor;
  for (ChannelConfig& channel : sensor.channels) {
    if (channel.stale_ms == channel.period_ms * 5) channel.stale_ms = 0;
    channel.period_ms = 0;
  }
  if (channels == nullptr) return;
  for (const json::Member& channel : channels->members)
    for (const json::Member& key : channel.value.members)
      if (key.key == "rate")
        diagnostics.report(Code::N0001, "this sensor is fed, not sampled: its rate is not used")
            .label(key.value.span);
}

// Without "channels", places in messages are those of the sensor's name.
void place_channels(SensorConfig& sensor) {
  for (ChannelConfig& channel : sensor.channels) {
    channel.name.span = sensor.name.span;
    channel.unit_span = sensor.name.span;
  }
}

}  // namespace

std::optional<SensorConfig> read_sensor(const json::Value& value, WiringReader& wiring,
                                        Diagnostics& diagnostics) {
  Fields fields(value, Object::sensor, diagnostics);
  const auto name = read_name(fields, "a sensor", diagnostics);
  const WiringType* type = read_type(fields, true, diagnostics);
  if (!name) return std::nullopt;
  const Device& device = choose_device(fields, type, *name, true, diagnostics);
  SensorConfig sensor = device.sensor;
  sensor.name = *name;
  place_channels(sensor);
  if (type != nullptr) {
    const Wiring place = wiring.read(fields, *type, true);
    sensor.bus = place.bus;
    sensor.address = place.place;
    if (type->name != "VIRTUAL" && device.has_driver && vm::is_on_i2c(sensor.driver))
      wiring.check_bus(fields, place);
  }
  if (const auto* number = fields.find("register"))
    for (ChannelConfig& channel : sensor.channels)
      channel.input = static_cast<std::uint8_t>(
          read_whole(*number, 0, device.inputs - 1, diagnostics).value_or(0));
  const auto* channels = fields.find("channels");
  if (channels != nullptr) read_channels(*channels, device, sensor, diagnostics);
  const bool is_virtual = type != nullptr && type->name == "VIRTUAL";
  if (is_virtual || !device.has_driver) make_fed(sensor, channels, diagnostics);
  for (const ChannelConfig& channel : sensor.channels)
    if (channel.period_ms != 0 && (sensor.period_ms == 0 || channel.period_ms < sensor.period_ms))
      sensor.period_ms = channel.period_ms;
  return sensor;
}

}  // namespace robosync::compiler
