// Numbers as people write them elsewhere: units that RSL does not have or calls otherwise (foreign_units.def), and a comma
// between digits.
#pragma once

#include <string_view>

#include "compiler/diagnostics/diagnostic.hpp"

namespace robosync::compiler {

// What one of it is, such as "1in is 2.54cm"; empty when it is none of these. Letters may be large.
std::string_view foreign_unit(std::string_view unit);

// The unit of RSL that another language calls so, such as "s" for "Sekunden"; empty when it is none of these.
std::string_view unit_word(std::string_view unit);

// `decimals` with the unit, if there is one. `1,000` is a thousand; `1,250` may be either, and gets no mend.
void report_decimal_comma(Diagnostics& diagnostics, Span place, std::string_view whole,
                          std::string_view decimals);

}  // namespace robosync::compiler
