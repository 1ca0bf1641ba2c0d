// What is proved of every part of an expression, from what is proved of that which it reads.
#pragma once

#include <map>
#include <vector>

#include "compiler/config/robot.hpp"
#include "compiler/ir/program.hpp"

namespace robosync::compiler {

using VariableFacts = std::vector<Fact>;         // by place in ir::Program::variables
using LocalFacts = std::map<std::size_t, Fact>;  // by ir::Local::number

// What an expression reads, when it is evaluated.
struct Sight {
  const Robot& robot;
  const VariableFacts& now;  // here
  const VariableFacts&
      anytime;  // in any step: time words in a response are evaluated in all of them
  const LocalFacts& locals;
};

// Fills in Expression::fact of all its parts; gives that of the whole.
Fact annotate(Expression& expression, const Sight& sight);

}  // namespace robosync::compiler
