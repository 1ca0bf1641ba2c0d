// See replay_readings.hpp.
#include "rsc/trace/replay_readings.hpp"

#include <cmath>
#include <exception>
#include <stdexcept>

#include <fmt/format.h>

#include "rsc/failure.hpp"
#include "rsc/json.hpp"
#include "rsc/trace/channels.hpp"
#include "rsc/trace/replay_event.hpp"

namespace robosync::tool {
namespace {

// A reading as in the trace: a label, or a number in the canonical unit.
vm::Value value_of(const vm::Image& image, std::uint8_t channel, const Json& value) {
  if (value.is_string()) return parse_reading(image, channel, value.get<std::string>());
  if (!value.is_number()) throw std::invalid_argument("its value is not a number");
  const double thousandths = thousandths_of(value);
  if (std::abs(thousandths) > vm::kValueMax) throw std::invalid_argument("its value is too large");
  return static_cast<vm::Value>(thousandths);
}

// By name, whatever measures it.
std::uint8_t channel_of(const vm::Image& image, const Json& event) {
  const std::string sensor = event.value("sensor", ""), channel = event.value("channel", "");
  for (std::size_t i = 0; i < image.channels.size(); ++i)
    if (image.string(image.channels[i].name) == channel &&
        image.string(image.sensors[image.channels[i].sensor].name) == sensor)
      return static_cast<std::uint8_t>(i);
  throw std::invalid_argument(fmt::format("it has no channel {}.{}", sensor, channel));
}

}  // namespace

Readings readings_of(const RecordedProgram& recorded, const vm::Image& image,
                     const std::string& file) {
  Readings readings;
  for (const auto& [line, event] : recorded.events) {
    const std::string kind = kind_of(event);
    if (kind != "input" && kind != "stale") continue;
    try {
      Told told{time_of(event), step_of(event), channel_of(image, event), std::nullopt, false};
      if (kind == "input")
        told.value = value_of(image, told.channel, event.value("value", Json(nullptr)));
      readings.push_back(told);
    } catch (const std::exception& error) {
      throw Failure(Exit::program, fmt::format("{}:{}: this reading does not fit the program: {}",
                                               file, line, error.what()));
    }
  }
  return readings;
}

std::set<std::uint8_t> silent_ones(const Readings& readings) {
  std::set<std::uint8_t> silent;
  for (const Told& told : readings)
    if (!told.value) silent.insert(told.channel);
  return silent;
}

}  // namespace robosync::tool
