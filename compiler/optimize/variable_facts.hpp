// What every variable of a program can be, whenever it is read.
#pragma once

#include "compiler/optimize/expression_facts.hpp"

namespace robosync::compiler {

// Fills in what is proved of the responses on the way (flow.hpp).
[[nodiscard]] VariableFacts prove_variables(ir::Program& program, const Robot& robot);

}  // namespace robosync::compiler
