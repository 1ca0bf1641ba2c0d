// Units, and exact conversion of written numbers to the robot's values (vm/value.hpp).
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "vm/image.hpp"

namespace robosync::compiler {

// value = (x * factor + offset) / divisor, in thousandths of the canonical unit.
struct Unit {
  std::string_view spelling;
  vm::Dimension dimension;
  std::int64_t factor, offset, divisor;
};

[[nodiscard]] std::span<const Unit> units();
// Any case is accepted, and a unit's other names. nullptr when there is no such unit. "" is the
// plain number.
[[nodiscard]] const Unit* find_unit(std::string_view spelling);
[[nodiscard]] const Unit& canonical_unit(vm::Dimension dimension);
[[nodiscard]] std::string_view dimension_phrase(vm::Dimension dimension);  // "a distance"

// A decimal number as written: mantissa / 10^decimals.
struct Decimal {
  std::int64_t mantissa = 0;
  unsigned decimals = 0;
};

// "12", "-0.5", "1e3". Nothing when it is not a number, or has more than 9 decimals or more than
// 16 digits: more than any value on the robot can hold.
[[nodiscard]] std::optional<Decimal> parse_decimal(std::string_view text);

// Rounded half away from zero. Nothing when out of range (±2,147,483.647 canonical units).
[[nodiscard]] std::optional<vm::Value> to_value(Decimal number, const Unit& unit);

// Is it written finer than a value on the robot? Only where it could be written so that it is not: never in rad or F.
[[nodiscard]] bool is_rounded(Decimal number, const Unit& unit);

// The value in `unit`, with as few decimals as say it to a thousandth, or say it at all (F): "2.5cm", "-3F".
[[nodiscard]] std::string format_value(std::int64_t value, const Unit& unit);

// The decimal number as it would be written: "-0.5".
[[nodiscard]] std::string written(Decimal number);

// What a robot can hold, in `unit`: "-2147483mm" and "2147483mm", nearer to 0 by less than the last digit shown.
[[nodiscard]] std::string smallest(const Unit& unit);
[[nodiscard]] std::string largest(const Unit& unit);
// Why the robot has no room for a number, as it was written, for messages.
[[nodiscard]] std::string no_room_for(std::string_view number, const Unit& unit);
// Why parse_decimal() gives nothing for what looks like a number, for messages; empty when that is not for its length.
[[nodiscard]] std::string too_many_digits(std::string_view text);

// A place for a value in a text that is written out: "{cm}" for a number of centimetres, "{}" for a plain
// one. The board sends the text and the values; whoever shows them puts them together.
struct ValuePlace {
  std::size_t begin = 0, size = 0;  // in the text
  const Unit* unit = nullptr;       // never null
};
[[nodiscard]] std::optional<ValuePlace> find_place(std::string_view text);
[[nodiscard]] std::string place_for(const Unit& unit);

// The smallest fraction numerator / denominator = thousandths of the canonical unit for one count
// of a sensor. Offsets of units (F) do not apply: it is a difference.
struct Scale {
  std::int32_t numerator = vm::kScale;
  std::uint16_t denominator = 1;
};
[[nodiscard]] std::optional<Scale> to_scale(Decimal number, const Unit& unit);
// Why it gives nothing, for messages.
[[nodiscard]] std::string why_no_scale(Decimal number, const Unit& unit);

}  // namespace robosync::compiler
