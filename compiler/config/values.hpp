// Reads typed values of robot.json. Each function reports what is wrong, with its place, and then returns nullopt. Numbers may be
// JSON numbers or strings, with a unit where that makes sense.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "compiler/config/json_reader.hpp"
#include "compiler/diagnostics/diagnostic.hpp"
#include "compiler/units/units.hpp"

namespace robosync::compiler {

[[nodiscard]] std::optional<std::string> read_text(const json::Value& value,
                                                   Diagnostics& diagnostics);

// Of a device on an I2C bus.
[[nodiscard]] std::optional<std::int64_t> read_address(const json::Value& value, std::int64_t low,
                                                       std::int64_t high, Diagnostics& diagnostics);
// 5, "5", "0x48": from `low` to `high`.
[[nodiscard]] std::optional<std::int64_t> read_whole(const json::Value& value, std::int64_t low,
                                                     std::int64_t high, Diagnostics& diagnostics);

// 5 and "5" (in `unit`), "5cm" (of the same dimension).
[[nodiscard]] std::optional<vm::Value> read_quantity(const json::Value& value, const Unit& unit,
                                                     Diagnostics& diagnostics);

// As read_quantity(), but for a difference: 9F is 5C, because the offsets of units do not count.
[[nodiscard]] std::optional<vm::Value> read_difference(const json::Value& value, const Unit& unit,
                                                       Diagnostics& diagnostics);

// 400, "400deg/s2": a change of `speed`, which is a unit of speed, in a second. In whole canonical units, as in the image.
[[nodiscard]] std::optional<std::uint16_t> read_acceleration(const json::Value& value,
                                                             const Unit& speed,
                                                             Diagnostics& diagnostics);

struct Range {
  vm::Value low = vm::kValueMin;
  vm::Value high = vm::kValueMax;
};
// [low, high], low < high.
[[nodiscard]] std::optional<Range> read_range(const json::Value& value, const Unit& unit,
                                              Diagnostics& diagnostics);

// ["0.6ms", "2400us"]: two times in whole microseconds.
[[nodiscard]] std::optional<std::array<std::uint16_t, 2>> read_microseconds(
    const json::Value& value, Diagnostics& diagnostics);
// "50Hz": milliseconds between two samples, 1 … 65535.
[[nodiscard]] std::optional<std::uint16_t> read_rate(const json::Value& value,
                                                     Diagnostics& diagnostics);
// "200ms": milliseconds, 1 … 65535.
[[nodiscard]] std::optional<std::uint16_t> read_milliseconds(const json::Value& value,
                                                             Diagnostics& diagnostics);
[[nodiscard]] std::optional<Scale> read_scale(const json::Value& value, const Unit& unit,
                                              Diagnostics& diagnostics);
// The name of a unit, "cm".
[[nodiscard]] const Unit* read_unit(const json::Value& value, Diagnostics& diagnostics);

// For E0303: suggests the nearest unit, or lists them all.
void suggest_unit(Diagnostic& diagnostic, std::string_view written);

}  // namespace robosync::compiler
