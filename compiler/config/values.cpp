#include "compiler/config/values.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <string_view>
#include <vector>

#include "compiler/config/fields.hpp"
#include "compiler/config/names.hpp"
#include "compiler/diagnostics/nearest.hpp"
#include "compiler/source/ascii.hpp"
#include "compiler/units/foreign_units.hpp"

namespace robosync::compiler {
namespace {

struct Written {  // "-2.5cm" split into its parts
  std::string_view number, unit;
};

Written split(std::string_view text) {
  std::size_t end = !text.empty() && text.front() == '-' ? 1 : 0;
  while (end < text.size() &&
         (std::isdigit(static_cast<unsigned char>(text[end])) != 0 || text[end] == '.'))
    ++end;
  std::string_view unit = text.substr(end);
  while (!unit.empty() && unit.front() == ' ')
    unit.remove_prefix(1);
  return {text.substr(0, end), unit};
}

bool is_number_or_text(const json::Value& value, std::string_view what, Diagnostics& diagnostics) {
  if (value.kind == json::Kind::number || value.kind == json::Kind::string) return true;
  diagnostics
      .report(Code::E0204, "this must be " + std::string(what) + ", not " +
                               std::string(json::kind_phrase(value.kind)))
      .label(value.span);
  return false;
}

// The number and its unit: `unit` if none is written.
struct Measured {
  Decimal number;
  const Unit* unit = nullptr;
};

const Unit* matching_unit(const json::Value& value, std::string_view written, const Unit& unit,
                          Diagnostics& diagnostics) {
  const Unit* found = find_unit(written);
  if (found == nullptr && written.size() > 1 && written[0] == ',' && ascii::is_digit(written[1])) {
    std::string better(value.text);
    better[better.find(',')] = '.';
    diagnostics.report(Code::E0304, "decimals follow a point, not a comma")
        .label(value.span, "write `\"" + better + "\"`");
    return nullptr;
  }
  if (found == nullptr) {
    suggest_unit(diagnostics.report(Code::E0303, "there is no unit `" + std::string(written) + "`")
                     .label(value.span),
                 std::string(written));
    return nullptr;
  }
  if (found->dimension == unit.dimension) return found;
  diagnostics
      .report(Code::E0301, "this is " + std::string(dimension_phrase(found->dimension)) + ", but " +
                               std::string(dimension_phrase(unit.dimension)) + " is needed here")
      .label(value.span);
  return nullptr;
}

std::optional<Measured> read_measured(const json::Value& value, const Unit& unit,
                                      Diagnostics& diagnostics) {
  if (!is_number_or_text(value, "a number or a string like \"5cm\"", diagnostics))
    return std::nullopt;
  Measured result{{}, &unit};
  std::string_view number = value.text;
  if (value.kind == json::Kind::string) {
    const Written written = split(value.text);
    number = written.number;
    if (number.empty() || number == "-") {
      diagnostics.report(Code::E0204, "there is no number in this string").label(value.span);
      return std::nullopt;
    }
    if (!written.unit.empty()) result.unit = matching_unit(value, written.unit, unit, diagnostics);
    if (result.unit == nullptr) return std::nullopt;
  }
  const auto decimal = parse_decimal(number);
  if (!decimal) {
    const std::string why = too_many_digits(number);
    diagnostics.report(Code::E0304, why.empty() ? "this number cannot be read" : why)
        .label(value.span);
    return std::nullopt;
  }
  result.number = *decimal;
  return result;
}

std::optional<vm::Value> value_of(const json::Value& value, Decimal number, const Unit& unit,
                                  Diagnostics& diagnostics) {
  const auto result = to_value(number, unit);
  if (!result) diagnostics.report(Code::E0304, no_room_for(value.text, unit)).label(value.span);
  return result;
}

std::optional<std::int64_t> parse_whole(std::string_view text) {
  int base = 10;
  if (text.starts_with("0x") || text.starts_with("0X")) {
    base = 16;
    text.remove_prefix(2);
    if (text.starts_with("-")) return std::nullopt;
  }
  std::int64_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number, base);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return number;
}

// A limit, in the base of the value.
std::string written_like(std::int64_t number, bool hex) {
  if (!hex || number < 0) return std::to_string(number);
  std::array<char, 16> digits{};
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), number, 16).ptr;
  return "0x" + std::string(digits.data(), end);
}

std::optional<std::uint16_t> milliseconds(std::int64_t ms, const json::Value& value,
                                          Diagnostics& diagnostics) {
  if (ms >= 1 && ms <= UINT16_MAX) return static_cast<std::uint16_t>(ms);
  diagnostics
      .report(Code::E0205, "this is " + std::to_string(ms) + " ms, but must be from 1 ms to " +
                               std::to_string(UINT16_MAX) + " ms")
      .label(value.span);
  return std::nullopt;
}

}  // namespace

std::optional<std::string> read_text(const json::Value& value, Diagnostics& diagnostics) {
  if (!expect_kind(value, json::Kind::string, diagnostics)) return std::nullopt;
  if (value.text.find('\0') != std::string::npos) {
    diagnostics.report(Code::E0205, "a text cannot contain a zero character").label(value.span);
    return std::nullopt;
  }
  return value.text;
}

std::optional<std::int64_t> read_whole(const json::Value& value, std::int64_t low,
                                       std::int64_t high, Diagnostics& diagnostics) {
  if (!is_number_or_text(value, "a whole number", diagnostics)) return std::nullopt;
  const auto number = parse_whole(value.text);
  if (!number) {
    Diagnostic& d =
        diagnostics.report(Code::E0204, "this must be a whole number, like 5 or \"0x48\"")
            .label(value.span);
    // "D9", "GPIO 9": as a board calls its pin
    const std::size_t digits = value.text.find_first_of("0123456789");
    const bool ends = value.text.find_first_not_of("0123456789", digits) == std::string::npos;
    if (digits != std::string::npos && ends && ascii::is_letter(value.text.front()))
      d.helps("write the number alone, such as `" + value.text.substr(digits) + "`");
    return std::nullopt;
  }
  if (*number >= low && *number <= high) return number;
  const bool hex = value.text.starts_with("0x") || value.text.starts_with("0X");
  diagnostics
      .report(Code::E0205,
              "this must be from " + written_like(low, hex) + " to " + written_like(high, hex))
      .label(value.span);
  return std::nullopt;
}

// Data sheets write addresses in base sixteen, and 29 for 0x29 is an address, too.
std::optional<std::int64_t> read_address(const json::Value& value, std::int64_t low,
                                         std::int64_t high, Diagnostics& diagnostics) {
  if (!is_number_or_text(value, "an address like \"0x48\"", diagnostics)) return std::nullopt;
  const auto fits = [&](const std::optional<std::int64_t>& number) {
    return number && *number >= low && *number <= high;
  };
  const auto address = parse_whole(value.text);
  const bool meant_hex = fits(parse_whole("0x" + value.text));  // never of one that has its 0x
  const std::string hex = "\"0x" + value.text + "\"";
  if (fits(address)) {
    if (meant_hex)
      diagnostics.report(Code::N0001, "this number is the address " + written_like(*address, true))
          .label(value.span)
          .helps("if the data sheet says 0x" + value.text + ", write " + hex);
    return address;
  }
  Diagnostic& d = diagnostics
                      .report(address ? Code::E0205 : Code::E0204,
                              "this must be an address from " + written_like(low, true) + " to " +
                                  written_like(high, true))
                      .label(value.span);
  if (meant_hex) {
    d.helps("write " + hex).fix(value.span, hex, Applicability::likely);
  } else if (!value.text.starts_with("0x") && !value.text.starts_with("0X")) {
    d.helps("write it as data sheets do: \"" + written_like(high, true) + "\"");
  }
  return std::nullopt;
}

std::optional<vm::Value> read_quantity(const json::Value& value, const Unit& unit,
                                       Diagnostics& diagnostics) {
  const auto measured = read_measured(value, unit, diagnostics);
  if (!measured) return std::nullopt;
  return value_of(value, measured->number, *measured->unit, diagnostics);
}

std::optional<vm::Value> read_difference(const json::Value& value, const Unit& unit,
                                         Diagnostics& diagnostics) {
  const auto measured = read_measured(value, unit, diagnostics);
  if (!measured) return std::nullopt;
  Unit difference = *measured->unit;
  difference.offset = 0;
  return value_of(value, measured->number, difference, diagnostics);
}

std::optional<std::uint16_t> read_acceleration(const json::Value& value, const Unit& speed,
                                               Diagnostics& diagnostics) {
  constexpr std::string_view kEnd = "/s2";
  json::Value in_a_second = value;
  if (value.kind == json::Kind::string && value.text.ends_with(kEnd))
    in_a_second.text.pop_back();
  else if (value.kind == json::Kind::string && !split(value.text).unit.empty())
    in_a_second.kind = json::Kind::null;
  Diagnostics said_below;
  const std::int64_t amount = read_quantity(in_a_second, speed, said_below).value_or(0);
  const std::int64_t whole = (amount + vm::kScale / 2) / vm::kScale;
  if (whole >= 1 && whole <= UINT16_MAX) return static_cast<std::uint16_t>(whole);
  diagnostics
      .report(Code::E0205, "this must be an acceleration from " + format_acceleration(1, speed) +
                               " to " + format_acceleration(UINT16_MAX, speed))
      .label(value.span)
      .helps("write it like \"" + format_acceleration(400, speed) + "\"");
  return std::nullopt;
}

std::optional<Range> read_range(const json::Value& value, const Unit& unit,
                                Diagnostics& diagnostics) {
  if (!expect_kind(value, json::Kind::array, diagnostics, "\"range\": [0, 10]"))
    return std::nullopt;
  if (value.items.size() != 2) {
    diagnostics.report(Code::E0204, "a range is a list of two values: the lowest and the highest")
        .label(value.span);
    return std::nullopt;
  }
  const auto low = read_quantity(value.items[0], unit, diagnostics);
  const auto high = read_quantity(value.items[1], unit, diagnostics);
  if (!low || !high) return std::nullopt;
  if (*low < *high) return Range{*low, *high};
  diagnostics.report(Code::E0205, "the lowest value of this range must be below the highest")
      .label(value.span);
  return std::nullopt;
}

std::optional<std::array<std::uint16_t, 2>> read_microseconds(const json::Value& value,
                                                              Diagnostics& diagnostics) {
  constexpr std::size_t kMostDigits = 9;
  std::array<std::uint16_t, 2> times{};
  std::size_t good = 0;
  for (const json::Value& item : value.items) {
    const Written written = split(item.text);
    const auto number = parse_decimal(written.number);
    const bool known = written.unit == "ms" || written.unit == "us";
    if (!number || !known || good == times.size() || written.number.size() > kMostDigits) break;
    std::int64_t time = number->mantissa * (written.unit == "ms" ? 1000 : 1);
    for (unsigned d = 0; d < number->decimals; ++d)
      time /= 10;
    times.at(good++) = static_cast<std::uint16_t>(std::clamp<std::int64_t>(time, 0, UINT16_MAX));
  }
  if (good == times.size() && value.items.size() == good) return times;
  diagnostics.report(Code::E0204, "these must be two lengths of a pulse, each in `ms` or `us`")
      .label(value.span)
      .helps("write them like `[\"0.6ms\", \"2.4ms\"]`");
  return std::nullopt;
}

std::optional<std::uint16_t> read_rate(const json::Value& value, Diagnostics& diagnostics) {
  const auto rate = read_quantity(value, canonical_unit(vm::Dimension::frequency), diagnostics);
  if (!rate) return std::nullopt;
  if (*rate <= 0) {
    diagnostics.report(Code::E0205, "a rate must be above 0").label(value.span);
    return std::nullopt;
  }
  constexpr vm::Value kMost = 1000 * vm::kScale;
  const std::int64_t ms = (kMost + std::int64_t{*rate} / 2) / *rate;
  if (*rate > kMost || ms > UINT16_MAX) {
    diagnostics
        .report(Code::E0205, *rate > kMost
                                 ? "a rate is 1000Hz at most: one reading in a millisecond"
                                 : "a rate is 0.016Hz at least: one reading in a minute")
        .label(value.span);
    return std::nullopt;
  }
  return static_cast<std::uint16_t>(ms);
}

std::optional<std::uint16_t> read_milliseconds(const json::Value& value, Diagnostics& diagnostics) {
  const auto time = read_quantity(value, canonical_unit(vm::Dimension::duration), diagnostics);
  if (!time) return std::nullopt;
  return milliseconds(*time, value, diagnostics);
}

std::optional<Scale> read_scale(const json::Value& value, const Unit& unit,
                                Diagnostics& diagnostics) {
  const auto measured = read_measured(value, unit, diagnostics);
  if (!measured) return std::nullopt;
  const auto scale = to_scale(measured->number, *measured->unit);
  if (!scale)
    diagnostics.report(Code::E0304, why_no_scale(measured->number, *measured->unit))
        .label(value.span);
  return scale;
}

const Unit* read_unit(const json::Value& value, Diagnostics& diagnostics) {
  const auto text = read_text(value, diagnostics);
  if (!text) return nullptr;
  const Unit* unit = find_unit(*text);
  if (unit == nullptr)
    suggest_unit(
        diagnostics.report(Code::E0303, "there is no unit `" + *text + "`").label(value.span),
        *text);
  return unit;
}

void suggest_unit(Diagnostic& diagnostic, std::string_view written) {
  if (const std::string_view ours = foreign_unit(written); !ours.empty()) {
    diagnostic.helps(std::string(ours));
    return;
  }
  if (const std::string_view ours = unit_word(written); !ours.empty()) {
    diagnostic.helps("did you mean `" + std::string(ours) + "`?");
    return;
  }
  std::vector<std::string> spellings;
  std::string list;
  for (const Unit& unit : units()) {
    if (unit.spelling.empty()) continue;
    spellings.emplace_back(unit.spelling);
    list += (list.empty() ? "" : " ") + spellings.back();
  }
  if (const auto near = nearest(written, spellings))
    diagnostic.helps("did you mean `" + *near + "`?");
  else
    diagnostic.helps("units: " + list);
}

}  // namespace robosync::compiler
