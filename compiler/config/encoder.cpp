// The encoder of a wheel: its pins, what one of its edges is worth, and whether a board can count them all.
#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <string>

#include <fmt/format.h>

#include "compiler/config/entries.hpp"
#include "compiler/config/values.hpp"
#include "compiler/config/wiring.hpp"
#include "vm/drivers.hpp"

namespace robosync::compiler {
namespace {

// A pulse has two edges.
constexpr std::int64_t kEdgesOfPulse = 2;
constexpr std::int64_t kMostPulses = 10'000;
constexpr vm::Value kLeastWheel = 5 * vm::kScale, kMostWheel = 500 * vm::kScale;  // mm
// 355 / 113 is pi, but for a ten-millionth.
constexpr std::int64_t kPiAbove = 355, kPiBelow = 113;

std::int64_t divided(std::int64_t above, std::int64_t below) {
  return (above + below / 2) / below;
}

const json::Value* range_of(const json::Value* channels, const std::string& name) {
  if (channels == nullptr) return nullptr;
  for (const json::Member& channel : channels->members)
    for (const json::Member& key : channel.value.members)
      if (channel.key == name && key.key == "range") return &key.value;
  return nullptr;
}

void check_edges(const Fields& fields, const json::Value* channels, const ChannelConfig& channel,
                 std::int64_t around, std::int64_t edges, Diagnostics& diagnostics) {
  const std::int64_t fastest =
      std::max(std::abs(std::int64_t{channel.min}), std::int64_t{channel.max});
  const std::int64_t most = std::int64_t{vm::kEdgesPerMs} * 1000;
  const std::int64_t a_second = divided(fastest * edges, around);
  if (a_second <= most) return;
  const Unit& unit = *channel.unit;
  const auto possible = static_cast<vm::Value>(most * around / edges);
  const json::Value* const range = range_of(channels, channel.name.text);
  diagnostics
      .report(
          Code::E0205,
          fmt::format("at {} this encoder gives {} edges a second, but a board counts at most {}",
                      format_value(static_cast<vm::Value>(fastest), unit), a_second, most))
      .label((range != nullptr ? range : fields.find("pulses_per_turn"))->span)
      .helps("if the wheel never turns that fast, give the channel `" + channel.name.text +
             "` a `range` of at most " + format_value(possible, unit));
}

}  // namespace

// `"pin": 5`, or with the direction `"pins": [5, 9]`. The image has one byte for the second one.
Wiring WiringReader::read_encoder(Fields& fields, const WiringType& type) {
  constexpr const char* kHelp =
      "write `\"pin\": 5`, or `\"pins\": [5, 9]` for an encoder with two channels, A and B";
  report_foreign(fields, type);
  Wiring wiring{.bus = vm::kNoSecondPin};
  const auto* pins = fields.find("pins");
  const auto* other = fields.find("active");
  if (other == nullptr && pins != nullptr) other = fields.find("pin");
  if (other != nullptr || (pins != nullptr && pins->items.size() != 2)) {
    diagnostics_.report(Code::E0205, "an encoder has one pin or two, and nothing else")
        .label((other != nullptr ? other : pins)->span)
        .helps(kHelp);
  } else if (pins != nullptr) {
    wiring.place = read_pin(pins->items[0]);
    wiring.bus = static_cast<std::uint8_t>(read_pin(pins->items[1], vm::kNoSecondPin - 1));
  } else if (const auto* pin = fields.require("pin", "an encoder")) {
    wiring.place = read_pin(*pin);
  }
  return wiring;
}

void WiringReader::check_encoder(const Fields& fields, const Wiring& wiring) {
  if (++encoders_ > vm::kMaxEncoders)
    diagnostics_
        .report(Code::E0207, fmt::format("a robot can have only {} encoders", vm::kMaxEncoders))
        .label(fields.find("device")->span);
  const auto* pins = fields.find("pins");
  if (pins != nullptr && pins->items.size() != 2) return;
  const auto* first = pins != nullptr ? &pins->items[0] : fields.find("pin");
  if (first != nullptr && !board_.has_echo(wiring.place))
    report_no_pin(*first, wiring.place, " is not an input whose edges are counted",
                  "those that are: ", board_.echoes);
  if (pins != nullptr && wiring.bus != vm::kNoSecondPin && !board_.has_input(wiring.bus))
    report_no_pin(pins->items[1], wiring.bus, " is not an input", "its inputs are the pins ",
                  board_.inputs);
}

void scale_encoder(Fields& fields, SensorConfig& sensor, const json::Value* channels,
                   Diagnostics& diagnostics) {
  const std::string what = "an encoder";
  const auto* pulses = fields.require("pulses_per_turn", what);
  const auto* wheel = fields.require("wheel", what);
  if (pulses == nullptr || wheel == nullptr) return;
  const auto each = read_whole(*pulses, 1, kMostPulses, diagnostics);
  const Unit& unit = canonical_unit(vm::Dimension::length);
  const auto diameter = read_quantity(*wheel, unit, diagnostics);
  if (!each || !diameter) return;
  if (*diameter < kLeastWheel || *diameter > kMostWheel) {
    diagnostics
        .report(Code::E0205, "the diameter of a wheel is " + format_value(kLeastWheel, unit) +
                                 " to " + format_value(kMostWheel, unit))
        .label(wheel->span);
    return;
  }
  const std::int64_t around = divided(*diameter * kPiAbove, kPiBelow);
  const std::int64_t edges = kEdgesOfPulse * *each;
  for (ChannelConfig& channel : sensor.channels) {
    const bool is_speed = channel.input != 0;
    const std::int64_t parts = is_speed ? vm::kSpeedParts : 1;
    channel.scale = {static_cast<std::int32_t>(divided(around, parts)),
                     static_cast<std::uint16_t>(edges)};
    channel.offset = 0;
    if (is_speed) check_edges(fields, channels, channel, around, edges, diagnostics);
  }
}

}  // namespace robosync::compiler
