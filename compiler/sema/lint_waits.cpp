// W0205: a WAIT UNTIL that may wait for ever, and keeps its actuators all the time.
#include "compiler/sema/lints.hpp"
#include "compiler/syntax/walk.hpp"

namespace robosync::compiler {
namespace {

void lint_block(const ast::Block& block, Diagnostics& diagnostics) {
  for_each_statement(block, [&](const ast::Stmt& stmt) {
    const auto* wait = std::get_if<ast::WaitUntil>(&stmt.node);
    if (wait == nullptr || wait->within != nullptr) return;
    diagnostics
        .report(Code::W0205, "this may wait for ever, and keeps the actuators of its response")
        .label(stmt.span)
        .helps("say how long at most: `WITHIN 10s`")
        .fix({stmt.span.file, stmt.span.end, stmt.span.end}, " WITHIN 10s");
  });
}

}  // namespace

void lint_waits(const LintInput& input) {
  const auto lint = [&](const ast::Block& block) { lint_block(block, input.diagnostics); };
  for (const ast::Item& item : input.tree.items) {
    if (const auto* define = std::get_if<ast::Define>(&item.node)) lint(define->body);
    if (const auto* rule = std::get_if<ast::Rule>(&item.node)) for_each_block(*rule, lint);
    if (const auto* behavior = std::get_if<ast::Behavior>(&item.node))
      for (const ast::Rule& rule : behavior->rules)
        for_each_block(rule, lint);
  }
}

}  // namespace robosync::compiler
