// Evaluates an expression at one moment, on its tree, with the robot's arithmetic.
#pragma once

#include "compiler/ir/program.hpp"

namespace robosync::compiler::test_plan {

// The values that are known at that moment.
class Moment {
public:
  virtual vm::Value channel(ChannelRef channel) const = 0;  // kUnknown: no reading
  virtual vm::Value variable(std::size_t index) const = 0;  // index in ir::Program::variables
  virtual vm::Value time() const = 0;                       // of the program

protected:
  ~Moment() = default;
};

// Returns a number, or kTrue, kFalse or kUnknown. Time words, random numbers and locals have no value at a single moment: they
// give kUnknown, and plan_tests() rejects them.
[[nodiscard]] vm::Value evaluate(const Expression& expression, const Moment& moment);

}  // namespace robosync::compiler::test_plan
