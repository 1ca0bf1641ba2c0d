// The compiler's units (compiler/config/units.def) are the only ones.
#include "rsc/quantity.hpp"

#include <algorithm>
#include <optional>
#include <stdexcept>

#include <fmt/format.h>

#include "compiler/config/units.hpp"

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

}  // namespace

vm::Value parse_quantity(std::string_view text, vm::Dimension dimension) {
  const std::string_view whole = trim(text);
  const auto unit_at = std::ranges::find_if_not(whole, is_number_part);
  const auto digits = static_cast<std::size_t>(unit_at - whole.begin());
  const auto number = compiler::parse_decimal(whole.substr(0, digits));
  if (!number) throw std::invalid_argument(fmt::format("`{}` is not a number with a unit", text));
  const std::string_view spelling = trim(whole.substr(digits));
  if (spelling.starts_with(','))
    throw std::invalid_argument(fmt::format("`{}` has a comma: a decimal point is a point", text));
  const compiler::Unit* const unit = compiler::find_unit(spelling);
  const compiler::Unit& canonical = compiler::canonical_unit(dimension);
  if (unit == nullptr) throw std::invalid_argument(fmt::format("there is no unit `{}`", spelling));
  if (unit->dimension != dimension) {
    throw std::invalid_argument(fmt::format(
        "`{}` is {}, but this is {}{}", text, compiler::dimension_phrase(unit->dimension),
        compiler::dimension_phrase(dimension),
        canonical.spelling.empty()
            ? ""
            : fmt::format("; write it as {}{}", whole.substr(0, digits), canonical.spelling)));
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
