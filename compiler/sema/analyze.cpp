// Walks the items of the program and its modules: first variables and limits, which may
// be anywhere in the file, then the rules in order.
#include "compiler/sema/analyze.hpp"

#include "compiler/sema/behaviors.hpp"
#include "compiler/sema/limits.hpp"
#include "compiler/sema/lints.hpp"
#include "compiler/sema/rules.hpp"
#include "compiler/sema/variables.hpp"
#include "compiler/sema/waiting_commands.hpp"

namespace robosync::compiler {
namespace {

class Analyzer {
public:
  Analyzer(const Trees& trees, const Robot& robot, const SourceMap& sources,
           Diagnostics& diagnostics)
      : trees_(trees),
        robot_(robot),
        diagnostics_(diagnostics),
        names_(trees, robot_, diagnostics),
        expressions_(names_, diagnostics),
        motions_(robot_, names_, expressions_, diagnostics),
        commands_(robot_, names_, expressions_, motions_, diagnostics),
        statements_(sources, robot_, names_, expressions_, commands_, diagnostics),
        rules_(sources, names_, expressions_, statements_, diagnostics),
        behaviors_(robot_, diagnostics) {}

  ir::Program run() {
    expressions_.check_constants();
    expressions_.check_lists();
    Variables(names_, expressions_, diagnostics_).declare(program_);
    for_each<ast::Limit>([this](const ast::Limit& limit, Span span) {
      Limits(robot_, names_, expressions_, diagnostics_)
          .add(limit, statements_.line_of(span), program_);
    });
    for_each<ast::Safety>([this](const ast::Safety& safety, Span span) {
      program_.safety.push_back(rules_.translate(safety, span));
    });
    for (const ast::Tree* tree : trees_)
      for (const ast::Item& item : tree->items)
        add(item);
    program_.words = names_.learned();
    program_.motions = motions_.performed();
    statements_.check_unused_defines();
    motions_.check_unused();
    program_.behaviors = behaviors_.finish();
    // After errors, some commands and uses may be missing.
    if (!diagnostics_.has_errors()) check_waiting_commands(program_, names_, diagnostics_);
    if (!diagnostics_.has_errors()) lint();
    return std::move(program_);
  }

private:
  template <typename Node, typename Visit>
  void for_each(const Visit& visit) {
    for (const ast::Tree* tree : trees_)
      for (const ast::Item& item : tree->items)
        if (const auto* node = std::get_if<Node>(&item.node)) visit(*node, item.span);
  }

  void lint() {
    const LintInput input{*trees_.front(), program_, robot_, names_, diagnostics_};
    lint_rules(input);
    lint_waits(input);
    lint_names(input);
    lint_robot(input);
  }

  void add(const ast::Item& item) {
    if (const auto* rule = std::get_if<ast::Rule>(&item.node))
      behaviors_.add_rule(rules_.translate(*rule, false), rule->modifiers.priority,
                          rule->head_span);
    if (const auto* behavior = std::get_if<ast::Behavior>(&item.node)) add(*behavior);
  }

  void add(const ast::Behavior& behavior) {
    std::vector<ir::Rule> rules;
    names_.set_scope(&behavior);
    for (const ast::Rule& rule : behavior.rules)
      rules.push_back(rules_.translate(rule, true));
    names_.set_scope(nullptr);
    behaviors_.add(behavior, std::move(rules));
  }

  const Trees& trees_;
  Robot robot_;  // with the program's limits
  Diagnostics& diagnostics_;
  Names names_;
  Expressions expressions_;
  Motions motions_;
  Commands commands_;
  Statements statements_;
  Rules rules_;
  Behaviors behaviors_;
  ir::Program program_;
};

}  // namespace

ir::Program analyze(const Trees& trees, const Robot& robot, const SourceMap& sources,
                    Diagnostics& diagnostics) {
  return Analyzer(trees, robot, sources, diagnostics).run();
}

}  // namespace robosync::compiler
