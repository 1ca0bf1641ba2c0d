// Walks over a translated response: every statement, inner ones included, outer ones first.
#pragma once

#include "compiler/sema/program.hpp"

namespace robosync::compiler {

template <typename Visit>
void for_each_statement(const ProgramBlock& block, const Visit& visit) {
  for (const ProgramStatement& statement : block) {
    visit(statement);
    if (const auto* choice = std::get_if<ProgramIf>(&statement.node)) {
      for_each_statement(choice->then_block, visit);
      for_each_statement(choice->else_block, visit);
    } else if (const auto* loop = std::get_if<ProgramRepeat>(&statement.node)) {
      for_each_statement(loop->body, visit);
    } else if (const auto* pick = std::get_if<ProgramPick>(&statement.node)) {
      for (const ProgramOption& option : pick->options)
        for_each_statement(option.body, visit);
    }
  }
}

template <typename Predicate>
bool any_command(const ProgramBlock& block, const Predicate& predicate) {
  bool found = false;
  for_each_statement(block, [&](const ProgramStatement& statement) {
    const auto* command = std::get_if<ProgramCommand>(&statement.node);
    found = found || (command != nullptr && predicate(*command));
  });
  return found;
}

}  // namespace robosync::compiler
