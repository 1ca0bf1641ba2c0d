// Proves facts for every part of an expression, from the facts of the values that it reads.
#pragma once

#include <map>
#include <vector>

#include "compiler/config/robot.hpp"
#include "compiler/ir/program.hpp"

namespace robosync::compiler {

using VariableFacts = std::vector<Fact>;         // by index in ir::Program::variables
using LocalFacts = std::map<std::size_t, Fact>;  // by ir::Local::number

// The facts of the values that an expression reads when it is evaluated.
struct Sight {
  const Robot& robot;
  const VariableFacts& now;  // here
  const VariableFacts&
      anytime;  // in any step: time words in a response are evaluated in every step
  const LocalFacts& locals;
};

// Fills in Expression::fact of all its parts; returns the fact of the whole.
Fact annotate(Expression& expression, const Sight& sight);

}  // namespace robosync::compiler
