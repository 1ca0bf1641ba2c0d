// Units that RSL does not have and people write all the same (foreign_units.def).
#pragma once

#include <string_view>

namespace robosync::compiler {

// What one of it is, such as "1in is 2.54cm"; empty when it is none of these. Letters may be large.
std::string_view foreign_unit(std::string_view unit);

}  // namespace robosync::compiler
