// The encoders of a differential drive: two sensors of the robot, by their names.
#include <algorithm>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "compiler/config/entries.hpp"
#include "compiler/config/values.hpp"
#include "compiler/diagnostics/nearest.hpp"
#include "vm/drivers.hpp"

namespace robosync::compiler {
namespace {

constexpr const char* kExample =
    "name the encoder of the left wheel, then that of the right one: `\"encoders\": [\"left\", "
    "\"right\"]`";

class EncoderReader {
public:
  EncoderReader(std::span<const SensorConfig> sensors, const ActuatorConfig& drive,
                Diagnostics& diagnostics)
      : sensors_(sensors), drive_(drive), diagnostics_(diagnostics) {}

  std::optional<std::array<std::size_t, 2>> read(const json::Value& value) {
    if (value.items.size() != 2) {
      diagnostics_.report(Code::E0205, "a drive has two encoders, or none")
          .label(value.span)
          .helps(kExample);
      return std::nullopt;
    }
    const auto left = find(value.items[0]);
    const auto right = find(value.items[1]);
    if (!left || !right) return std::nullopt;
    if (*left != *right) return std::array{*left, *right};
    diagnostics_.report(Code::E0205, "both wheels of the drive have the same encoder")
        .label(value.items[1].span)
        .label(value.items[0].span, "here, too", false)
        .helps(kExample);
    return std::nullopt;
  }

private:
  std::optional<std::size_t> find(const json::Value& value) {
    const auto name = read_text(value, diagnostics_);
    if (!name) return std::nullopt;
    const auto found = std::ranges::find_if(
        sensors_, [&](const SensorConfig& sensor) { return same_name(sensor.name.text, *name); });
    if (found == sensors_.end()) {
      report_unknown(value);
      return std::nullopt;
    }
    if (!is_usable(*found, value)) return std::nullopt;
    return static_cast<std::size_t>(found - sensors_.begin());
  }

  void report_unknown(const json::Value& value) {
    std::vector<std::string> known;
    for (const SensorConfig& sensor : sensors_)
      if (vm::counts_edges(sensor.driver)) known.push_back(sensor.name.text);
    Diagnostic& d = diagnostics_.report(Code::E0501, "there is no sensor `" + value.text + "`")
                        .label(value.span);
    if (did_you_mean(d, value.span, value.text, known, "\"")) return;
    d.helps(known.empty() ? "add one with `\"device\": \"encoder\"` to `sensors`"
                          : "encoders: " + list_names(known));
  }

  bool is_usable(const SensorConfig& sensor, const json::Value& value) {
    if (sensor.is_unknown) return false;
    if (!vm::counts_edges(sensor.driver)) return report_no_encoder(sensor, value);
    const auto distance = distance_of(sensor);
    if (distance) return is_slow_enough(sensor, sensor.channels[*distance].scale, value);
    diagnostics_
        .report(Code::E0205, "the encoder " + sensor.name.shown() +
                                 " has no DISTANCE, so nothing says how far an edge is")
        .label(value.span)
        .label(sensor.name.span, "this sensor", false)
        .helps("add `\"DISTANCE\": {}` to its `channels`");
    return false;
  }

  bool report_no_encoder(const SensorConfig& sensor, const json::Value& value) {
    const bool is_fed = same_name(sensor.device, "encoder");
    Diagnostic& d =
        diagnostics_
            .report(Code::E0205,
                    sensor.name.shown() + (is_fed ? " is VIRTUAL, so nothing counts its edges"
                                                  : " is not an encoder"))
            .label(value.span)
            .label(sensor.name.span, "this sensor", false);
    d.helps(is_fed ? "wire it, as `\"type\": \"GPIO\"`; `rsc run` turns its wheel"
                   : "a wheel's sensor has `\"device\": \"encoder\"`");
    return false;
  }

  // Otherwise the board would lose edges, and the drive stop, at full power.
  bool is_slow_enough(const SensorConfig& sensor, const Scale& edge, const json::Value& value) {
    constexpr std::int64_t kMost = std::int64_t{vm::kEdgesPerMs} * 1000;
    if (!drive_.drive || edge.numerator <= 0) return true;
    const std::int64_t a_second =
        std::int64_t{drive_.drive->speed} * edge.denominator / edge.numerator;
    if (a_second <= kMost) return true;
    diagnostics_
        .report(
            Code::E0205,
            fmt::format("at {}, the drive's `speed`, the encoder {} gives {} edges a second, but "
                        "a board counts at most {}",
                        format_value(drive_.drive->speed, *drive_.at_unit), sensor.name.shown(),
                        a_second, kMost))
        .label(value.span)
        .helps("an encoder on the wheel, not on its motor, gives fewer");
    return false;
  }

  std::span<const SensorConfig> sensors_;
  const ActuatorConfig& drive_;
  Diagnostics& diagnostics_;
};

std::int8_t read_difference(const json::Value& value, Diagnostics& diagnostics) {
  const Unit& percent = canonical_unit(vm::Dimension::percent);
  const auto read = read_quantity(value, percent, diagnostics);
  if (!read) return kUsualDifference;
  const vm::Value whole = *read / vm::kScale;
  if (*read % vm::kScale == 0 && whole >= -vm::kMostDifference && whole <= vm::kMostDifference)
    return static_cast<std::int8_t>(whole);
  diagnostics
      .report(Code::E0205, fmt::format("this is a whole number of percent, -{0} to {0}",
                                       int{vm::kMostDifference}))
      .label(value.span);
  return kUsualDifference;
}

}  // namespace

void read_wheel_encoders(const Fields& fields, std::span<const SensorConfig> sensors,
                         ActuatorConfig& actuator, Diagnostics& diagnostics) {
  const auto* encoders = fields.find("encoders");
  const auto* difference = fields.find("simulated_difference");
  if (encoders == nullptr) {
    if (difference != nullptr)
      diagnostics.report(Code::E0205, "without `encoders` a simulation does not turn the wheels")
          .label(difference->span);
    return;
  }
  std::int8_t slower = kUsualDifference;
  if (difference != nullptr) slower = read_difference(*difference, diagnostics);
  if (!expect_kind(*encoders, json::Kind::array, diagnostics)) return;
  actuator.encoders = EncoderReader(sensors, actuator, diagnostics).read(*encoders);
  if (!actuator.encoders) return;
  actuator.bus = static_cast<std::uint8_t>(slower);
  actuator.encoder_spans = {encoders->items[0].span, encoders->items[1].span};
}

}  // namespace robosync::compiler
