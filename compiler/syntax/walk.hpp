// The one walk over the blocks of a tree. kBlocks (ast.hpp) lists the blocks that a statement holds;
// a kind of statement without it does not compile.
#pragma once

#include <concepts>
#include <ranges>
#include <tuple>
#include <variant>

#include "compiler/syntax/ast.hpp"

namespace robosync::compiler::ast {

// Visits the blocks of a statement, or of a part of one; not the blocks nested in them.
template <typename Part, typename Visit>
void for_each_block_of(const Part& part, const Visit& visit) {
  if constexpr (std::same_as<Part, Block>) {
    visit(part);
  } else if constexpr (std::ranges::range<Part>) {
    for (const auto& one : part)
      for_each_block_of(one, visit);
  } else {
    std::apply([&](auto... member) { (for_each_block_of(part.*member, visit), ...); },
               Part::kBlocks);
  }
}

// Visits every statement of a block, including nested ones, outer ones first.
template <typename Visit>
void for_each_statement(const Block& block, const Visit& visit) {
  const auto inner = [&](const Block& one) { for_each_statement(one, visit); };
  for (const Stmt& stmt : block) {
    visit(stmt);
    std::visit([&](const auto& node) { for_each_block_of(node, inner); }, stmt.node);
  }
}

// Visits the blocks of a rule: one, or two with ELSE.
template <typename Visit>
void for_each_block(const Rule& rule, const Visit& visit) {
  std::visit(
      [&](const auto& node) {
        if constexpr (requires { node.body; }) {
          visit(node.body);
        } else {
          visit(node.then_block);
          if (node.else_block) visit(*node.else_block);
        }
      },
      rule.node);
}

}  // namespace robosync::compiler::ast
