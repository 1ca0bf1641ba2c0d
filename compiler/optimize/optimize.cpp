#include "compiler/optimize/optimize.hpp"

#include "compiler/codegen/walk.hpp"
#include "compiler/optimize/prune.hpp"
#include "compiler/optimize/share.hpp"
#include "compiler/optimize/simplify.hpp"
#include "compiler/optimize/variable_facts.hpp"

namespace robosync::compiler {
namespace {

void simplify(ProgramBlock& block) {
  const PartsOfStatement parts([](Expression& expression) { simplify(expression); },
                               [](ProgramBlock& inner) { simplify(inner); });
  for (ProgramStatement& statement : block)
    std::visit(parts, statement.node);
}

void simplify(ProgramRule& rule) {
  simplify(rule.condition);
  if (rule.resume) simplify(*rule.resume);
  simplify(rule.then_response);
  simplify(rule.else_response);
}

template <typename OnRule>
void for_each_rule(Program& program, OnRule on_rule) {
  for (ProgramRule& rule : program.safety)
    on_rule(rule);
  for (ProgramBehavior& behavior : program.behaviors)
    for (ProgramRule& rule : behavior.rules)
      on_rule(rule);
}

// Facts of responses, then those of conditions.
void prove(Program& program, const Robot& robot) {
  const VariableFacts facts = prove_variables(program, robot);
  const LocalFacts no_locals;
  for_each_rule(program, [&](ProgramRule& rule) {
    annotate(rule.condition, {robot, facts, facts, no_locals});
    if (rule.resume) annotate(*rule.resume, {robot, facts, facts, no_locals});
  });
}

}  // namespace

Program optimize(Program program, const Robot& robot) {
  for_each_rule(program, [](ProgramRule& rule) { simplify(rule); });
  prove(program, robot);
  prune(program);
  share_numbers(program);
  prove(program, robot);
  program.optimized = true;
  return program;
}

}  // namespace robosync::compiler
