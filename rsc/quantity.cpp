// Uses the compiler's units (compiler/units/units.def).
#include "rsc/quantity.hpp"

#include <algorithm>
#include <cstdlib>
#include <optional>
#include <stdexcept>
#include <vector>

#include <fmt/format.h>

#include "compiler/source/ascii.hpp"
#include "compiler/units/units.hpp"

namespace robosync::tool {
namespace {

bool is_number_part(char c) {
  return compiler::ascii::is_digit(c) || c == '.' || c == '-' || c == '+';
}

// How much of the text is a number, with an exponent as other programs write it: 1e-05.
std::size_t number_length(std::string_view text) {
  const auto end =
      static_cast<std::size_t>(std::ranges::find_if_not(text, is_number_part) - text.begin());
  if (end == 0 || end == text.size() || (text[end] != 'e' && text[end] != 'E')) return end;
  const std::size_t digits = std::min(text.find_first_not_of("+-", end + 1), text.size());
  std::size_t last = digits;
  while (last < text.size() && compiler::ascii::is_digit(text[last]))
    ++last;
  return last > digits ? last : end;
}

// Other programs write more digits than the compiler reads: 0.30000000000000004.
std::optional<compiler::Decimal> number_of(const std::string& digits) {
  if (const auto exact = compiler::parse_decimal(digits)) return exact;
  char* end = nullptr;
  const double number = std::strtod(digits.c_str(), &end);
  if (digits.empty() || *end != '\0') return std::nullopt;
  return compiler::parse_decimal(fmt::format("{:.6f}", number));
}

std::string_view trim(std::string_view text) {
  const auto begin = text.find_first_not_of(" \t");
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(" \t") - begin + 1);
}

// "; write it as 20cm" for a bare number whose unit is certain: its own, or the only one possible. Else the units that
// fit, without the number: 20 could be in any of them.
std::string way_out(std::string_view number, vm::Dimension dimension, std::string_view own) {
  std::vector<std::string_view> fitting;
  for (const compiler::Unit& unit : compiler::units())
    if (unit.dimension == dimension) fitting.push_back(unit.spelling);
  if (fitting.front().empty()) return {};
  if (own.empty() && fitting.size() == 1) own = fitting.front();
  if (!number.empty() && !own.empty()) return fmt::format("; write it as {}{}", number, own);
  const std::string_view last = fitting.back();
  fitting.pop_back();
  return fmt::format("; it takes a number with {}{}{}", fmt::join(fitting, ", "),
                     fitting.empty() ? "" : " or ", last);
}

}  // namespace

vm::Value parse_quantity(std::string_view text, vm::Dimension dimension, std::string_view own) {
  const std::string_view whole = trim(text);
  const std::size_t digits = number_length(whole);
  const auto number = number_of(std::string(whole.substr(0, digits)));
  if (!number) throw std::invalid_argument(fmt::format("`{}` is not a number with a unit", text));
  const std::string_view spelling = trim(whole.substr(digits));
  if (spelling.starts_with(','))
    throw std::invalid_argument(
        fmt::format("`{}` has a comma: write the decimal point as a point", text));
  const compiler::Unit* const unit = compiler::find_unit(spelling);
  if (unit == nullptr) throw std::invalid_argument(fmt::format("there is no unit `{}`", spelling));
  if (unit->dimension != dimension) {
    throw std::invalid_argument(fmt::format(
        "`{}` is {}, but this is {}{}", text, compiler::dimension_phrase(unit->dimension),
        compiler::dimension_phrase(dimension),
        way_out(spelling.empty() ? whole : std::string_view(), dimension, own)));
  }
  const std::optional<vm::Value> value = compiler::to_value(*number, *unit);
  if (!value) throw std::invalid_argument(fmt::format("`{}` is too large for the robot", text));
  return *value;
}

std::string format_quantity(vm::Value value, vm::Dimension dimension) {
  if (value == vm::kUnknown) return "unknown";
  return compiler::format_value(value, compiler::canonical_unit(dimension));
}

std::chrono::milliseconds parse_duration(std::string_view text) {
  const vm::Value thousandths = parse_quantity(text, vm::Dimension::duration);
  if (thousandths < 0) throw std::invalid_argument(fmt::format("`{}` is negative", text));
  return std::chrono::milliseconds(thousandths);
}

}  // namespace robosync::tool
