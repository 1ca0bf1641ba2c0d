// See foreign_units.hpp.
#include "compiler/units/foreign_units.hpp"

#include <algorithm>
#include <iterator>
#include <string>

#include "compiler/source/ascii.hpp"

namespace robosync::compiler {

std::string_view foreign_unit(std::string_view unit) {
#define FOREIGN_UNIT(spelling, one) \
  if (ascii::same(unit, spelling)) return "1" spelling " is " one;
#define UNIT_WORD(word, ours)
#include "compiler/units/foreign_units.def"
#undef UNIT_WORD
#undef FOREIGN_UNIT
  return {};
}

namespace {

struct UnitWord {
  std::string_view word, ours;
};
constexpr UnitWord kUnitWords[] = {
#define FOREIGN_UNIT(spelling, one)
#define UNIT_WORD(word, ours) {word, ours},
#include "compiler/units/foreign_units.def"
#undef UNIT_WORD
#undef FOREIGN_UNIT
};

}  // namespace

std::string_view unit_word(std::string_view unit) {
  const auto* const found = std::ranges::find_if(
      kUnitWords, [unit](const UnitWord& one) { return ascii::same(unit, one.word); });
  return found == std::end(kUnitWords) ? std::string_view{} : found->ours;
}

void report_decimal_comma(Diagnostics& diagnostics, Span place, std::string_view whole,
                          std::string_view decimals) {
  const std::size_t digits = std::min(decimals.find_first_not_of("0123456789"), decimals.size());
  constexpr std::size_t thousands = 3;
  const bool may_be_thousand = digits == thousands && whole.find_first_not_of('0') == 0;
  const std::string fraction = std::string(whole) + "." + std::string(decimals);
  const std::string thousand = std::string(whole) + std::string(decimals);
  if (!may_be_thousand) {
    diagnostics.report(Code::E0004, "decimals follow a point, not a comma")
        .label(place, "write `" + fraction + "`")
        .fix(place, fraction, Applicability::likely);
    return;
  }
  Diagnostic& message = diagnostics.report(Code::E0004, "a number contains no comma")
                            .label(place, "write `" + thousand + "`");
  if (decimals.substr(0, digits) == "000")
    message.fix(place, thousand, Applicability::likely);
  else
    message.helps("or, if these are decimals, `" + fraction + "`");
}

}  // namespace robosync::compiler
