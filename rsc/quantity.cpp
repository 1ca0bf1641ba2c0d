// Uses the compiler's units (compiler/units/units.def).
#include "rsc/quantity.hpp"

#include <algorithm>
#include <optional>
#include <stdexcept>
#include <vector>

#include <fmt/format.h>

#include "compiler/units/units.hpp"

namespace robosync::tool {
namespace {

bool is_number_part(char c) {
  return (c >= '0' && c <= '9') || c == '.' || c == '-' || c == '+';
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
  const auto unit_at = std::ranges::find_if_not(whole, is_number_part);
  const auto digits = static_cast<std::size_t>(unit_at - whole.begin());
  const auto number = compiler::parse_decimal(whole.substr(0, digits));
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
