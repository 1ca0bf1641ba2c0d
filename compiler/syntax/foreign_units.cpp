// See foreign_units.hpp.
#include "compiler/syntax/foreign_units.hpp"

#include "compiler/source/ascii.hpp"

namespace robosync::compiler {

std::string_view foreign_unit(std::string_view unit) {
#define FOREIGN_UNIT(spelling, one) \
  if (ascii::same(unit, spelling)) return "1" spelling " is " one;
#include "compiler/syntax/foreign_units.def"
#undef FOREIGN_UNIT
  return {};
}

}  // namespace robosync::compiler
