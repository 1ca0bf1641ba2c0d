// Walks over the tree: every statement of a block, inner ones included, outer ones first.
#pragma once

#include <type_traits>

#include "compiler/syntax/ast.hpp"

namespace robosync::compiler {

template <typename Visit>
void for_each_statement(const ast::Block& block, const Visit& visit) {
  for (const ast::Stmt& stmt : block) {
    visit(stmt);
    if (const auto* choice = std::get_if<ast::If>(&stmt.node)) {
      for_each_statement(choice->then_block, visit);
      for_each_statement(choice->else_block, visit);
    } else if (const auto* loop = std::get_if<ast::Repeat>(&stmt.node)) {
      for_each_statement(loop->body, visit);
    } else if (const auto* pick = std::get_if<ast::PickOne>(&stmt.node)) {
      for (const ast::Option& option : pick->options)
        for_each_statement(option.body, visit);
    }
  }
}

// The blocks of a rule: one, or two with ELSE.
template <typename Visit>
void for_each_block(const ast::Rule& rule, const Visit& visit) {
  std::visit(
      [&](const auto& node) {
        if constexpr (std::is_same_v<decltype(node), const ast::WhenRule&>) {
          visit(node.then_block);
          if (node.else_block) visit(*node.else_block);
        } else {
          visit(node.body);
        }
      },
      rule.node);
}

}  // namespace robosync::compiler
