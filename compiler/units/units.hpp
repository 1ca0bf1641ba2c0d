// Units, and exact conversion of written numbers to values on the robot (vm/value.hpp).
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
// Accepts any case and a unit's other names. nullptr if there is no such unit. "" is the plain number.
[[nodiscard]] const Unit* find_unit(std::string_view spelling);
[[nodiscard]] const Unit& canonical_unit(vm::Dimension dimension);
// The unit of a difference: 9F more are 5C more, so the one of F has no offset. The others are their own.
[[nodiscard]] const Unit& difference_unit(const Unit& unit);
[[nodiscard]] bool is_of_differences(const Unit& unit);                    // only: false for cm
[[nodiscard]] std::string_view dimension_phrase(vm::Dimension dimension);  // "a distance"

// The unit of a written number: the text after its digits.
[[nodiscard]] std::string_view written_unit(std::string_view number);

// A decimal number as written: mantissa / 10^decimals.
struct Decimal {
  std::int64_t mantissa = 0;
  unsigned decimals = 0;
};

// "12", "-0.5", "1e3". nullopt if it is not a number, or has more than 9 decimals or more than 16 digits: more than any value on
// the robot can hold.
[[nodiscard]] std::optional<Decimal> parse_decimal(std::string_view text);

// Rounded half away from zero. nullopt if out of range (±2,147,483.647 canonical units).
[[nodiscard]] std::optional<vm::Value> to_value(Decimal number, const Unit& unit);

// True if it is written with more precision than the robot keeps and could have been exact: never in rad or F.
[[nodiscard]] bool is_rounded(Decimal number, const Unit& unit);

// The value in `unit`, with as few decimals as express it to a thousandth, or at all (F): "2.5cm", "-3F".
[[nodiscard]] std::string format_value(std::int64_t value, const Unit& unit);

// An acceleration, in whole canonical units, as a change of a speed in a second: "400deg/s2".
[[nodiscard]] std::string format_acceleration(std::int64_t whole, const Unit& speed);

// The decimal number as text: "-0.5".
[[nodiscard]] std::string written(Decimal number);

// The limits of a value on the robot, in `unit`: "-2147483mm" and "2147483mm", closer to 0 by less than the last digit shown.
[[nodiscard]] std::string smallest(const Unit& unit);
[[nodiscard]] std::string largest(const Unit& unit);
// For messages: why a number, as it was written, does not fit on the robot.
[[nodiscard]] std::string no_room_for(std::string_view number, const Unit& unit);
// For messages: why parse_decimal() rejects what looks like a number; empty if its length is not the reason.
[[nodiscard]] std::string too_many_digits(std::string_view text);

// A place for a value in a text that is output: "{cm}" for a number of centimetres, "{}" for a plain one, "{+F}" for a difference
// of temperatures, "{|calm|happy}" for a word, of which the value is the index. The board sends the text and the values
// separately; the host combines them.
struct ValuePlace {
  std::size_t begin = 0, size = 0;  // in the text
  const Unit* unit = nullptr;       // null: it shows a word
  std::string_view words{};         // "|calm|happy"
};
[[nodiscard]] std::optional<ValuePlace> find_place(std::string_view text);
[[nodiscard]] std::string place_for(const Unit& unit);
// Empty if one of the words has a character with a meaning in a place.
[[nodiscard]] std::string place_for(std::span<const std::string> words);
// What stands at the place of this value; "unknown" for kUnknown.
[[nodiscard]] std::string shown_at(const ValuePlace& place, vm::Value value);

// The fraction numerator / denominator, in lowest terms, = thousandths of the canonical unit for one count of a sensor. Offsets
// of units (F) do not apply, because it is a difference.
struct Scale {
  std::int32_t numerator = vm::kScale;
  std::uint16_t denominator = 1;
};
[[nodiscard]] std::optional<Scale> to_scale(Decimal number, const Unit& unit);
// For messages: why to_scale() returns nullopt.
[[nodiscard]] std::string why_no_scale(Decimal number, const Unit& unit);

}  // namespace robosync::compiler
