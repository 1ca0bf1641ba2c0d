// The parts of a statement: every expression and every block that it holds, in the program's order.
#pragma once

#include "compiler/sema/program.hpp"

namespace robosync::compiler {

template <typename OnExpression, typename OnBlock>
class PartsOfStatement {
public:
  PartsOfStatement(OnExpression on_expression, OnBlock on_block)
      : expression_(on_expression), block_(on_block) {}

  void operator()(const ProgramCommand& command) const {
    for (const ProgramArgument& argument : command.arguments)
      expression_(argument.value);
  }
  void operator()(const ProgramLocal& local) const { expression_(local.value); }
  void operator()(const ProgramSet& set) const { expression_(set.value); }
  void operator()(const ProgramWait& wait) const { expression_(wait.duration); }
  void operator()(const ProgramWaitUntil& wait) const {
    expression_(wait.condition);
    if (wait.within) expression_(*wait.within);
  }
  void operator()(const ProgramThen&) const {}
  void operator()(const ProgramIf& choice) const {
    expression_(choice.condition);
    block_(choice.then_block);
    block_(choice.else_block);
  }
  void operator()(const ProgramRepeat& repeat) const {
    expression_(repeat.control);
    block_(repeat.body);
  }
  void operator()(const ProgramPick& pick) const {
    for (const ProgramOption& option : pick.options)
      block_(option.body);
  }
  void operator()(const ProgramLog& log) const {
    for (const Expression& value : log.values)
      expression_(value);
  }
  void operator()(const ProgramAlert&) const {}
  void operator()(const ProgramHalt&) const {}

private:
  OnExpression expression_;
  OnBlock block_;
};

}  // namespace robosync::compiler
