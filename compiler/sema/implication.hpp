// Does one condition follow from another? Says yes only when it surely does.
#pragma once

#include "compiler/ir/program.hpp"

namespace robosync::compiler {

[[nodiscard]] bool implies(const Expression& condition, const Expression& consequence);

}  // namespace robosync::compiler
