// Walks over a program. The parts of a statement are listed in its kParts (ir/program.hpp); a kind of statement without kParts
// does not compile.
//
// Visitors may read the parts, and change them if they are not const.
#pragma once

#include <concepts>
#include <optional>
#include <ranges>
#include <tuple>
#include <type_traits>
#include <variant>

#include "compiler/ir/program.hpp"

namespace robosync::compiler {

template <typename Part, typename OnExpression, typename OnBlock>
void visit_part(Part& part, const OnExpression& on_expression, const OnBlock& on_block) {
  using Kind = std::remove_const_t<Part>;
  if constexpr (std::same_as<Kind, Expression>) {
    on_expression(part);
  } else if constexpr (std::same_as<Kind, ir::Block>) {
    on_block(part);
  } else if constexpr (std::same_as<Kind, std::optional<Expression>>) {
    if (part) on_expression(*part);
  } else if constexpr (std::ranges::range<Kind>) {
    for (auto& one : part)
      visit_part(one, on_expression, on_block);
  } else {
    std::apply([&](auto... member) { (visit_part(part.*member, on_expression, on_block), ...); },
               Kind::kParts);
  }
}

// Visits the expressions and blocks of a statement, in the program's order, but not the contents of the blocks. `statement`: an
// ir::Statement, or its node.
template <typename Statement, typename OnExpression, typename OnBlock>
void for_each_part(Statement& statement, const OnExpression& on_expression,
                   const OnBlock& on_block) {
  if constexpr (std::same_as<std::remove_const_t<Statement>, ir::Statement>)
    std::visit([&](auto& node) { visit_part(node, on_expression, on_block); }, statement.node);
  else
    visit_part(statement, on_expression, on_block);
}

template <typename Statement, typename OnExpression>
void for_each_expression(Statement& statement, const OnExpression& on_expression) {
  for_each_part(statement, on_expression, [](const auto&) {});
}

template <typename Statement, typename OnBlock>
void for_each_block(Statement& statement, const OnBlock& on_block) {
  for_each_part(
      statement, [](const auto&) {}, on_block);
}

// Visits every statement of a block and of its inner blocks, outer ones first.
template <typename Block, typename Visit>
requires std::same_as<std::remove_const_t<Block>, ir::Block>
void for_each_statement(Block& block, const Visit& visit) {
  for (auto& statement : block) {
    visit(statement);
    for_each_block(statement, [&](auto& inner) { for_each_statement(inner, visit); });
  }
}

// Visits every statement of one kind, in the same order.
template <typename Node, typename Block, typename Visit>
void for_each_of(Block& block, const Visit& visit) {
  for_each_statement(block, [&](auto& statement) {
    if (auto* node = std::get_if<Node>(&statement.node)) visit(*node);
  });
}

// Visits every rule: SAFETY first, then those of the behaviours in order.
template <typename AnyProgram, typename Visit>
requires std::same_as<std::remove_const_t<AnyProgram>, ir::Program>
void for_each_rule(AnyProgram& program, const Visit& visit) {
  for (auto& rule : program.safety)
    visit(rule);
  for (auto& behavior : program.behaviors)
    for (auto& rule : behavior.rules)
      visit(rule);
}

// Visits the responses of a rule: one, or two with ELSE. An empty one is visited, too.
template <typename Rule, typename Visit>
void for_each_response(Rule& rule, const Visit& visit) {
  visit(rule.then_response);
  visit(rule.else_response);
}

template <typename Predicate>
bool any_command(const ir::Block& block, const Predicate& predicate) {
  bool found = false;
  for_each_of<ir::Command>(
      block, [&](const ir::Command& command) { found = found || predicate(command); });
  return found;
}

}  // namespace robosync::compiler
