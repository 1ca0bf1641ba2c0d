// Promises a channel of the image or a message that names the nearest one.
#include "rsc/trace/channels.hpp"

#include <optional>
#include <stdexcept>
#include <vector>

#include <fmt/format.h>

#include "compiler/diagnostics/nearest.hpp"
#include "rsc/names.hpp"
#include "rsc/quantity.hpp"

namespace robosync::tool {
namespace {

[[noreturn]] void no_such(std::string_view what, std::string_view name,
                          const std::vector<std::string>& known) {
  const auto near = compiler::nearest(name, known);
  throw std::invalid_argument(
      fmt::format("there is no {} `{}`{}", what, name,
                  near ? fmt::format("; did you mean `{}`?", *near) : std::string()));
}

std::uint8_t channel_of(const vm::Image& image, const vm::Sensor& sensor, std::string_view name) {
  const auto channels = image.channels.subspan(sensor.first_channel, sensor.channel_count);
  if (name.empty() && channels.size() == 1) return sensor.first_channel;
  std::vector<std::string> known;
  for (std::size_t i = 0; i < channels.size(); ++i) {
    const std::string_view candidate = image.string(channels[i].name);
    if (same_name(candidate, name)) return static_cast<std::uint8_t>(sensor.first_channel + i);
    known.emplace_back(candidate);
  }
  if (name.empty()) {
    throw std::invalid_argument(fmt::format("`{}` has several channels; name one of them: {}",
                                            image.string(sensor.name), fmt::join(known, ", ")));
  }
  no_such(fmt::format("channel of {}", image.string(sensor.name)), name, known);
}

}  // namespace

std::uint8_t find_channel(const vm::Image& image, std::string_view sensor,
                          std::string_view channel) {
  std::vector<std::string> known;
  for (const vm::Sensor& candidate : image.sensors) {
    const std::string_view name = image.string(candidate.name);
    if (same_name(name, sensor)) return channel_of(image, candidate, channel);
    known.emplace_back(name);
  }
  no_such("sensor", sensor, known);
}

std::uint8_t find_channel(const vm::Image& image, std::string_view name) {
  const std::size_t split = name.find_first_of(". ");
  if (split == std::string_view::npos) return find_channel(image, name, "");
  return find_channel(image, name.substr(0, split), name.substr(split + 1));
}

vm::Value parse_reading(const vm::Image& image, std::uint8_t channel, std::string_view text) {
  const vm::Channel& record = image.channels[channel];
  if (record.label_count == 0) return parse_quantity(text, record.dimension);
  std::vector<std::string> labels;
  for (std::size_t i = 0; i < record.label_count; ++i) {
    labels.emplace_back(image.string(image.labels[record.first_label + i]));
    if (same_name(labels.back(), text)) return static_cast<vm::Value>(i) * vm::kScale;
  }
  if (labels.size() == 2 && same_name(text, "false")) return 0;
  if (labels.size() == 2 && same_name(text, "true")) return vm::kScale;
  no_such(fmt::format("reading of {}", image.string(record.name)), text, labels);
}

}  // namespace robosync::tool
