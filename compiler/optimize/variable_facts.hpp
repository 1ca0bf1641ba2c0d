// Facts about each variable of a program that hold whenever it is read.
#pragma once

#include "compiler/optimize/expression_facts.hpp"

namespace robosync::compiler {

// Also fills in the facts of the responses (flow.hpp).
[[nodiscard]] VariableFacts prove_variables(ir::Program& program, const Robot& robot);

}  // namespace robosync::compiler
