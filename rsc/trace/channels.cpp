// Promises a channel of the image or a message that names the nearest one.
#include "rsc/trace/channels.hpp"

#include <algorithm>
#include <optional>
#include <stdexcept>
#include <vector>

#include <fmt/format.h>

#include "compiler/diagnostics/nearest.hpp"
#include "compiler/source/ascii.hpp"
#include "rsc/quantity.hpp"
#include "runtime-m4/policy/threads.hpp"

namespace robosync::tool {
namespace {

[[noreturn]] void no_such(std::string_view what, std::string_view name,
                          const std::vector<std::string>& known) {
  constexpr std::size_t kMostListed = 8;
  const auto near = compiler::nearest(name, known);
  std::string mend;
  if (near)
    mend = fmt::format("; did you mean `{}`?", *near);
  else if (known.size() <= kMostListed)
    mend = fmt::format("; known: {}", fmt::join(known, ", "));
  throw std::invalid_argument(fmt::format("there is no {} `{}`{}", what, name, mend));
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
  no_such(fmt::format("channel of {}", image.string(sensor.name)), name, known);
}

// Is this the channel `name` ("touch.LEVEL"), or a candidate if no channel is named?
bool is_channel(std::string_view name, std::string_view sensor, std::string_view channel) {
  const std::size_t dot = name.find('.');
  return compiler::ascii::same(name.substr(0, dot), sensor) &&
         (channel.empty() || compiler::ascii::same(name.substr(dot + 1), channel));
}

// The sensor's channels in robot.json, also those that the program does not read.
std::vector<std::string> channels_of(const Program& program, std::string_view sensor) {
  std::vector<std::string> names;
  for (const auto& [name, unit] : program.origin().units.channels)
    if (is_channel(name, sensor, {})) names.push_back(name.substr(name.find('.') + 1));
  return names;
}

struct DottedName {
  std::string_view sensor, channel;
};

DottedName split(std::string_view name) {
  const std::size_t at = name.find_first_of(". ");
  if (at == std::string_view::npos) return {name, ""};
  return {name.substr(0, at), name.substr(at + 1)};
}

}  // namespace

std::uint8_t find_channel(const vm::Image& image, std::string_view sensor,
                          std::string_view channel) {
  std::vector<std::string> known;
  for (const vm::Sensor& candidate : image.sensors) {
    const std::string_view name = image.string(candidate.name);
    if (compiler::ascii::same(name, sensor)) return channel_of(image, candidate, channel);
    known.emplace_back(name);
  }
  no_such("sensor", sensor, known);
}

std::uint8_t find_channel(const vm::Image& image, std::string_view name) {
  const DottedName parts = split(name);
  return find_channel(image, parts.sensor, parts.channel);
}

std::optional<std::uint8_t> find_read_channel(const Program& program, std::string_view sensor,
                                              std::string_view channel) {
  const DottedName name = channel.empty() ? split(sensor) : DottedName{sensor, channel};
  const auto meant = [&](const auto& entry) {
    return is_channel(entry.first, name.sensor, name.channel);
  };
  const std::vector<std::string> all = channels_of(program, name.sensor);
  if (name.channel.empty() && all.size() > 1) has_several(name.sensor, all);
  const vm::Image& image = program.image();
  const bool read = std::ranges::any_of(image.channels, [&](const vm::Channel& candidate) {
    return compiler::ascii::same(image.string(image.sensors[candidate.sensor].name), name.sensor) &&
           (name.channel.empty() ||
            compiler::ascii::same(image.string(candidate.name), name.channel));
  });
  if (!read && std::ranges::any_of(program.origin().units.channels, meant)) return std::nullopt;
  return find_channel(image, name.sensor, name.channel);
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
  no_such(fmt::format("reading of {}", image.string(record.name)), text, labels);
}

}  // namespace robosync::tool
