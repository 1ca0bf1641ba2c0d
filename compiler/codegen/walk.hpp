// The parts of a statement: every expression and every block that it holds, in the program's order.
#pragma once

#include <concepts>
#include <type_traits>

#include "compiler/sema/program.hpp"

namespace robosync::compiler {

// A statement of this kind, to be looked at or to be changed.
template <typename Statement, typename Kind>
concept Either = std::same_as<std::remove_const_t<Statement>, Kind>;

template <typename OnExpression, typename OnBlock>
class PartsOfStatement {
public:
  PartsOfStatement(OnExpression on_expression, OnBlock on_block)
      : expression_(on_expression), block_(on_block) {}

  void operator()(Either<ProgramCommand> auto& command) const {
    for (auto& argument : command.arguments)
      expression_(argument.value);
  }
  void operator()(Either<ProgramLocal> auto& local) const { expression_(local.value); }
  void operator()(Either<ProgramSet> auto& set) const { expression_(set.value); }
  void operator()(Either<ProgramWait> auto& wait) const { expression_(wait.duration); }
  void operator()(Either<ProgramWaitUntil> auto& wait) const {
    expression_(wait.condition);
    if (wait.within) expression_(*wait.within);
  }
  void operator()(Either<ProgramThen> auto&) const {}
  void operator()(Either<ProgramIf> auto& choice) const {
    expression_(choice.condition);
    block_(choice.then_block);
    block_(choice.else_block);
  }
  void operator()(Either<ProgramRepeat> auto& repeat) const {
    expression_(repeat.control);
    block_(repeat.body);
  }
  void operator()(Either<ProgramPick> auto& pick) const {
    for (auto& option : pick.options)
      block_(option.body);
  }
  void operator()(Either<ProgramLog> auto& log) const {
    for (auto& value : log.values)
      expression_(value);
  }
  void operator()(Either<ProgramAlert> auto&) const {}
  void operator()(Either<ProgramHalt> auto&) const {}

private:
  OnExpression expression_;
  OnBlock block_;
};

}  // namespace robosync::compiler
