// A differential drive: the pins of its two motors, and what makes times of its ways.
#include <algorithm>
#include <array>
#include <string>
#include <string_view>

#include "compiler/config/entries.hpp"
#include "compiler/config/values.hpp"
#include "vm/drivers.hpp"

namespace robosync::compiler {
namespace {

constexpr std::string_view kWhat = "a differential drive";
constexpr std::array<std::string_view, 2> kSideKeys = {"left", "right"};

// Then `left` and `right` are not also missed.
bool has_pins(const Fields& fields, Diagnostics& diagnostics) {
  for (const char* key : {"pins", "pin"}) {
    const auto* const wrong = fields.find(key);
    if (wrong == nullptr) continue;
    diagnostics
        .report(Code::E0206,
                std::string(kWhat) + " needs the keys `left` and `right`, not `" + key + "`")
        .label(wrong->span)
        .helps("write the pins of each: `\"left\": [4, 5], \"right\": [6, 7]`");
    return true;
  }
  return false;
}

// Above 0 and at most `most`.
vm::Value read_measure(const json::Value& value, const Unit& unit, vm::Value most,
                       Diagnostics& diagnostics) {
  const auto read = read_quantity(value, unit, diagnostics);
  if (!read) return 0;
  if (*read > 0 && *read <= most) return *read;
  diagnostics
      .report(Code::E0205, "this must be above " + format_value(0, unit) +
                               (most == vm::kValueMax ? std::string()
                                                      : " and at most " + format_value(most, unit)))
      .label(value.span);
  return 0;
}

void read_trim(const json::Value& value, vm::DriveParameters& drive, Diagnostics& diagnostics) {
  const Fields fields(value, Object::trim, diagnostics);
  const Unit& percent = canonical_unit(vm::Dimension::percent);
  for (std::size_t side = 0; side < kSideKeys.size(); ++side) {
    const auto* trim = fields.find(kSideKeys.at(side));
    if (trim == nullptr) continue;
    const auto read = read_quantity(*trim, percent, diagnostics);
    if (!read) continue;
    const vm::Value whole = *read / vm::kScale;
    if (*read % vm::kScale == 0 && whole >= kLeastTrim && whole <= vm::kFullTrim)
      drive.trim.at(side) = static_cast<std::uint8_t>(whole);
    else
      diagnostics
          .report(Code::E0205, "a trim is a whole number of percent, " +
                                   std::to_string(kLeastTrim) + " to " +
                                   std::to_string(vm::kFullTrim))
          .label(trim->span)
          .helps("give the faster motor less: `\"trim\": {\"left\": \"95%\"}`");
  }
}

}  // namespace

std::optional<vm::DriveParameters> read_drive(Fields& fields, WiringReader& wiring,
                                              const ActuatorConfig& actuator,
                                              Diagnostics& diagnostics) {
  if (has_pins(fields, diagnostics)) return std::nullopt;
  vm::DriveParameters drive{};
  drive.trim = {vm::kFullTrim, vm::kFullTrim};
  drive.usual = actuator.usual_speed * vm::kScale;
  bool whole = true;
  for (std::size_t side = 0; side < kSideKeys.size(); ++side) {
    const auto* pins = fields.require(kSideKeys.at(side), kWhat);
    const auto read = pins == nullptr ? std::nullopt : wiring.read_motor(*pins, kSideKeys.at(side));
    whole = whole && read;
    if (read) std::ranges::copy(*read, drive.pins.begin() + static_cast<std::ptrdiff_t>(2 * side));
  }
  if (const auto* speed = fields.require("speed", kWhat))
    drive.speed = read_measure(*speed, *actuator.at_unit, vm::kValueMax, diagnostics);
  if (const auto* track = fields.require("track", kWhat))
    drive.track = read_measure(*track, *actuator.to_unit, vm::kMostTrack, diagnostics);
  if (const auto* trim = fields.find("trim")) read_trim(*trim, drive, diagnostics);
  if (!whole || drive.speed == 0 || drive.track == 0) return std::nullopt;
  return drive;
}

}  // namespace robosync::compiler
