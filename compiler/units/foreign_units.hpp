// Numbers as people write them elsewhere: units that RSL lacks or names differently (foreign_units.def), and a comma
// between digits.
#pragma once

#include <string_view>

#include "compiler/diagnostics/diagnostic.hpp"

namespace robosync::compiler {

// The value of one unit, such as "1in is 2.54cm"; empty for any other word. Ignores case.
std::string_view foreign_unit(std::string_view unit);

// The RSL unit for a word of another language, such as "s" for "Sekunden"; empty for any other word.
std::string_view unit_word(std::string_view unit);

// `decimals` includes the unit, if any. `1,000` is a thousand; `1,250` is ambiguous and gets no fix.
void report_decimal_comma(Diagnostics& diagnostics, Span place, std::string_view whole,
                          std::string_view decimals);

}  // namespace robosync::compiler
