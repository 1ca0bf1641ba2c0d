#include "compiler/optimize/optimize.hpp"

#include "compiler/ir/walk.hpp"
#include "compiler/optimize/prune.hpp"
#include "compiler/optimize/share.hpp"
#include "compiler/optimize/simplify.hpp"
#include "compiler/optimize/variable_facts.hpp"

namespace robosync::compiler {
namespace {

void simplify(ir::Block& block) {
  for_each_statement(block, [](ir::Statement& statement) {
    for_each_expression(statement, [](Expression& expression) { simplify(expression); });
  });
}

void simplify(ir::Rule& rule) {
  simplify(rule.condition);
  if (rule.resume) simplify(*rule.resume);
  simplify(rule.then_response);
  simplify(rule.else_response);
}

// Proves the facts of responses, then those of conditions.
void prove(ir::Program& program, const Robot& robot) {
  const VariableFacts facts = prove_variables(program, robot);
  const LocalFacts no_locals;
  for_each_rule(program, [&](ir::Rule& rule) {
    annotate(rule.condition, {robot, facts, facts, no_locals});
    if (rule.resume) annotate(*rule.resume, {robot, facts, facts, no_locals});
  });
}

}  // namespace

ir::Program optimize(ir::Program program, const Robot& robot) {
  const Room room = room_in(program);
  for_each_rule(program, [](ir::Rule& rule) { simplify(rule); });
  prove(program, robot);
  prune(program);
  share_numbers(program, room);
  prove(program, robot);
  program.optimized = true;
  program.shares = room.in_registers;
  return program;
}

}  // namespace robosync::compiler
