// What an expression is worth at one moment, worked out on its tree with the robot's arithmetic.
#pragma once

#include "compiler/ir/program.hpp"

namespace robosync::compiler::test_plan {

// What is known at that moment.
class Moment {
public:
  virtual vm::Value channel(ChannelRef channel) const = 0;  // kUnknown: no reading
  virtual vm::Value variable(std::size_t index) const = 0;  // place in ir::Program::variables
  virtual vm::Value time() const = 0;                       // of the program

protected:
  ~Moment() = default;
};

// A number, or kTrue, kFalse or kUnknown. Time words, chance and locals, which no moment knows, are
// kUnknown; plan_tests() lets none of them through.
[[nodiscard]] vm::Value evaluate(const Expression& expression, const Moment& moment);

}  // namespace robosync::compiler::test_plan
