// Operations on two values as the robot does them, so that neither folding a constant nor judging a
// TEST can differ from what a program does.
#pragma once

#include "compiler/ir/expression.hpp"

namespace robosync::compiler {

// Of arithmetic, comparisons, AND and OR; of others kUnknown.
[[nodiscard]] vm::Value compute(Operation operation, vm::Value left, vm::Value right);

}  // namespace robosync::compiler
