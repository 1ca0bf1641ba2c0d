#include "compiler/optimize/optimize.hpp"

#include "compiler/ir/walk.hpp"
#include "compiler/optimize/prune.hpp"
#include "compiler/optimize/share.hpp"
#include "compiler/optimize/simplify.hpp"
#include "compiler/optimize/variable_facts.hpp"

namespace robosync::compiler {
namespace {

void simplify(ProgramBlock& block) {
  for_each_statement(block, [](ProgramStatement& statement) {
    for_each_expression(statement, [](Expression& expression) { simplify(expression); });
  });
}

void simplify(ProgramRule& rule) {
  simplify(rule.condition);
  if (rule.resume) simplify(*rule.resume);
  simplify(rule.then_response);
  simplify(rule.else_response);
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
  const Room room = room_in(program);
  for_each_rule(program, [](ProgramRule& rule) { simplify(rule); });
  prove(program, robot);
  prune(program);
  share_numbers(program, room);
  prove(program, robot);
  program.optimized = true;
  program.shares = room.in_registers;
  return program;
}

}  // namespace robosync::compiler
