// Promises a channel of the image or a message that names the nearest one.
#include "rsc/trace/channels.hpp"

#include <algorithm>
#include <optional>
#include <stdexcept>
#include <vector>

#include <fmt/format.h>

#include "compiler/diagnostics/nearest.hpp"
#include "compiler/source/ascii.hpp"
#include "compiler/units/units.hpp"
#include "rsc/quantity.hpp"
#include "runtime-m4/policy/threads.hpp"

namespace robosync::tool {
namespace {

// `what`: "there is no sensor", "touch has no channel".
[[noreturn]] void no_such(std::string_view what, std::string_view name,
                          const std::vector<std::string>& known) {
  throw std::invalid_argument(fmt::format("{} `{}`{}", what, name, instead_of(name, known)));
}

[[noreturn]] void no_such_channel(std::string_view sensor, std::string_view name,
                                  const std::vector<std::string>& known) {
  no_such(fmt::format("{} has no channel", sensor), name, known);
}

[[noreturn]] void has_several(std::string_view sensor, const std::vector<std::string>& channels) {
  throw std::invalid_argument(fmt::format("`{}` has several channels; name one of them: {}", sensor,
                                          fmt::join(channels, ", ")));
}

std::uint8_t channel_of(const vm::Image& image, const vm::Sensor& sensor, std::string_view name) {
  if (policy::is_algorithm(sensor))
    throw std::invalid_argument(
        fmt::format("`{}` is an algorithm and cannot be fed; it makes its readings of `{}`",
                    image.string(sensor.name),
                    image.string(image.sensors[policy::input_of(image, sensor)].name)));
  const auto channels = image.channels.subspan(sensor.first_channel, sensor.channel_count);
  if (name.empty() && channels.size() == 1) return sensor.first_channel;
  std::vector<std::string> known;
  for (std::size_t i = 0; i < channels.size(); ++i) {
    const std::string_view candidate = image.string(channels[i].name);
    if (compiler::ascii::same(candidate, name))
      return static_cast<std::uint8_t>(sensor.first_channel + i);
    known.emplace_back(candidate);
  }
  if (name.empty()) has_several(image.string(sensor.name), known);
  no_such_channel(image.string(sensor.name), name, known);
}

// A sensor with one channel need not name it.
bool is_meant(std::string_view channel, std::string_view name) {
  return name.empty() || compiler::ascii::same(channel, name);
}

struct DottedName {
  std::string_view sensor, channel;
};

DottedName split(std::string_view name) {
  const std::size_t at = name.find_first_of(". ");
  if (at == std::string_view::npos) return {name, ""};
  return {name.substr(0, at), name.substr(at + 1)};
}

struct KnownChannel {
  DottedName name;
  const compiler::Unit* unit;
};

// Those of robot.json, also if the program does not read them; those of the image if only that is known.
std::vector<KnownChannel> all_channels(const Program& program) {
  std::vector<KnownChannel> all;
  for (const auto& [name, unit] : program.origin().units.channels)
    all.push_back({split(name), unit});
  if (!all.empty()) return all;
  const vm::Image& image = program.image();
  for (const vm::Channel& channel : image.channels)
    all.push_back(
        {{image.string(image.sensors[channel.sensor].name), image.string(channel.name)}, nullptr});
  return all;
}

}  // namespace

std::string instead_of(std::string_view name, const std::vector<std::string>& known) {
  constexpr std::size_t kMostListed = 8;
  if (const auto near = compiler::nearest(name, known))
    return fmt::format("; did you mean `{}`?", *near);
  return known.size() <= kMostListed ? fmt::format("; known: {}", fmt::join(known, ", ")) : "";
}

std::uint8_t find_channel(const vm::Image& image, std::string_view sensor,
                          std::string_view channel) {
  std::vector<std::string> known;
  for (const vm::Sensor& candidate : image.sensors) {
    const std::string_view name = image.string(candidate.name);
    if (compiler::ascii::same(name, sensor)) return channel_of(image, candidate, channel);
    known.emplace_back(name);
  }
  no_such("there is no sensor", sensor, known);
}

std::uint8_t find_channel(const vm::Image& image, std::string_view name) {
  const DottedName parts = split(name);
  return find_channel(image, parts.sensor, parts.channel);
}

FoundChannel find_read_channel(const Program& program, std::string_view sensor,
                               std::string_view channel) {
  const DottedName name = channel.empty() ? split(sensor) : DottedName{sensor, channel};
  std::vector<std::string> sensors, channels;
  const compiler::Unit* unit = nullptr;
  for (const auto& [known, its_unit] : all_channels(program)) {
    if (sensors.empty() || sensors.back() != known.sensor) sensors.emplace_back(known.sensor);
    if (!compiler::ascii::same(known.sensor, name.sensor)) continue;
    channels.emplace_back(known.channel);
    if (is_meant(known.channel, name.channel)) unit = its_unit;
  }
  if (channels.empty()) no_such("there is no sensor", name.sensor, sensors);
  if (name.channel.empty() && channels.size() > 1) has_several(name.sensor, channels);
  const auto is_name = [&](std::string_view known) { return is_meant(known, name.channel); };
  if (std::ranges::none_of(channels, is_name)) no_such_channel(name.sensor, name.channel, channels);
  const vm::Image& image = program.image();
  const bool read = std::ranges::any_of(image.channels, [&](const vm::Channel& candidate) {
    return compiler::ascii::same(image.string(image.sensors[candidate.sensor].name), name.sensor) &&
           is_name(image.string(candidate.name));
  });
  if (!read) return {std::nullopt, unit};
  return {find_channel(image, name.sensor, name.channel), unit};
}

std::string_view unit_of(const Program& program, std::uint8_t channel) {
  const vm::Image& image = program.image();
  const vm::Channel& record = image.channels[channel];
  const std::string name = fmt::format("{}.{}", image.string(image.sensors[record.sensor].name),
                                       image.string(record.name));
  const auto& units = program.origin().units.channels;
  const auto found = units.find(name);
  if (found == units.end() || found->second == nullptr) return {};
  return found->second->spelling;
}

std::string range_note(const Program& program, std::uint8_t channel, vm::Value value) {
  const vm::Image& image = program.image();
  const vm::Channel& range = image.channels[channel];
  if (value >= range.min && value <= range.max) return {};
  const compiler::Unit* const written = compiler::find_unit(unit_of(program, channel));
  const bool fits = written != nullptr && written->dimension == range.dimension;
  const compiler::Unit& unit = fits ? *written : compiler::canonical_unit(range.dimension);
  const auto text = [&](vm::Value one) { return compiler::format_value(one, unit); };
  return fmt::format("{} is out of the range of {} {}, {} to {}: the robot reads {}", text(value),
                     image.string(image.sensors[range.sensor].name), image.string(range.name),
                     text(range.min), text(range.max),
                     text(std::clamp(value, range.min, range.max)));
}

vm::Value parse_reading(const vm::Image& image, std::uint8_t channel, std::string_view text,
                        std::string_view unit) {
  const vm::Channel& record = image.channels[channel];
  if (record.label_count == 0) return parse_quantity(text, record.dimension, unit);
  std::vector<std::string> labels;
  for (std::size_t i = 0; i < record.label_count; ++i) {
    labels.emplace_back(image.string(image.labels[record.first_label + i]));
    if (compiler::ascii::same(labels.back(), text)) return static_cast<vm::Value>(i) * vm::kScale;
  }
  if (labels.size() == 2 && compiler::ascii::same(text, "false")) return 0;
  if (labels.size() == 2 && compiler::ascii::same(text, "true")) return vm::kScale;
  no_such(fmt::format("{} has no word", image.string(record.name)), text, labels);
}

}  // namespace robosync::tool
