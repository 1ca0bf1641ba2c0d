// A program's variables: the values of REMEMBER, STATE, FEELING and signals, and its CHECKs.
#pragma once

#include "compiler/sema/expressions.hpp"

namespace robosync::compiler {

class Variables {
public:
  Variables(Names& names, Expressions& expressions, Diagnostics& diagnostics)
      : names_(names), expressions_(expressions), diagnostics_(diagnostics) {}

  // Fills in the variables and checks of `program`, in the order of Names::variables(). After that,
  // expressions can read them.
  void declare(ir::Program& program);

private:
  void declare(const ast::Remember& node, VariableName& name, ir::Variable& result);
  void check_kept();
  static void declare_timer(VariableName& name);
  void declare(const ast::State& node, VariableName& name, ir::Variable& result);
  void declare(const ast::Feeling& node, VariableName& name, ir::Variable& result);
  void fade(const ast::Feeling& node, const Wanted& wanted, ir::Variable& result);
  std::optional<vm::Value> inside(const ast::Expr& expr, const Wanted& wanted,
                                  const ir::Variable& feeling);
  void check_labels(const std::vector<ast::Name>& labels);

  // CHECK
  void declare(const ast::Check& node, VariableName& name, ir::Program& program);
  Typed input(const ast::Check& node);
  std::optional<vm::Band> band(const ast::Band& node, const Wanted& wanted, vm::Value margin);
  void smooth(const ast::Check& node, const Typed& input, ir::Check& result);

  Names& names_;
  Expressions& expressions_;
  Diagnostics& diagnostics_;
};

}  // namespace robosync::compiler
