// W0206, W0211: names and labels that play no part.
#include <map>
#include <set>

#include "compiler/ir/walk.hpp"
#include "compiler/sema/lints.hpp"

namespace robosync::compiler {
namespace {

using Entered = std::map<std::size_t, std::set<vm::Value>>;  // labels set, by variable

Entered labels_set(const Program& program) {
  Entered result;
  for_each_rule(program, [&](const ProgramRule& rule) {
    for_each_response(rule, [&](const ProgramBlock& block) {
      for_each_of<ProgramSet>(block, [&](const ProgramSet& set) {
        if (program.variables[set.variable].kind == vm::VariableKind::state)
          result[set.variable].insert(set.value.constant);
      });
    });
  });
  return result;
}

void lint_state(const ast::State& state, const std::set<vm::Value>& entered,
                Diagnostics& diagnostics) {
  if (entered.empty()) {
    diagnostics.report(Code::W0206, "nothing ever sets `" + state.name.text + "`")
        .label(state.name.span);
    return;
  }
  for (std::size_t i = 0; i < state.labels.size(); ++i) {
    const ast::Name& label = state.labels[i];
    const bool set = entered.contains(static_cast<vm::Value>(i) * vm::kScale);
    if (!set && i != 0)
      diagnostics
          .report(Code::W0206, "`" + state.name.text + "` is never set to `" + label.text + "`")
          .label(label.span);
    else if (set && entered.size() == 1)
      diagnostics
          .report(Code::W0206, "once `" + state.name.text + "` is `" + label.text +
                                   "`, nothing sets it to something else")
          .label(label.span);
  }
}

void lint_unused(const LintInput& input) {
  for (const auto& [folded, define] : input.names.defines())
    if (!define.used && !define.in_module)
      input.diagnostics.report(Code::W0211, "nothing runs `" + define.define->name.text + "`")
          .label(define.span);
  for (const auto& [folded, constant] : input.names.constants())
    if (!constant.used && !constant.in_module)
      input.diagnostics.report(Code::W0211, "nothing uses `" + constant.let->name.text + "`")
          .label(constant.let->name.span);
}

}  // namespace

void lint_names(const LintInput& input) {
  lint_unused(input);
  const Entered entered = labels_set(input.program);
  for (const VariableName& variable : input.names.variables()) {
    const auto* state = std::get_if<const ast::State*>(&variable.declared);
    if (state == nullptr || variable.in_module) continue;
    const auto found = entered.find(variable.index);
    lint_state(**state, found == entered.end() ? std::set<vm::Value>{} : found->second,
               input.diagnostics);
  }
}

}  // namespace robosync::compiler
