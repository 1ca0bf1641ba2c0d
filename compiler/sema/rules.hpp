// Translates rules: their triggers and modifiers, and SAFETY.
#pragma once

#include "compiler/sema/statements.hpp"

namespace robosync::compiler {

class Rules {
public:
  Rules(const SourceMap& sources, const Names& names, Expressions& expressions,
        Statements& statements, Diagnostics& diagnostics)
      : sources_(sources),
        names_(names),
        expressions_(expressions),
        statements_(statements),
        diagnostics_(diagnostics) {}

  // Reports mistakes. `inside`: in a BEHAVIOR.
  [[nodiscard]] ir::Rule translate(const ast::Rule& rule, bool inside);
  [[nodiscard]] ir::Rule translate(const ast::Safety& safety, Span span);

private:
  void translate(const ast::Rule& rule, const ast::WhenRule& node, ir::Rule& result);
  void translate(const ast::Rule& rule, const ast::WhileRule& node, ir::Rule& result);
  void translate(const ast::Rule& rule, const ast::EveryRule& node, ir::Rule& result);
  void translate(const ast::Rule& rule, const ast::AtStartRule& node, ir::Rule& result);
  Expression period(const ast::EveryRule& node);
  void modify(const ast::Rule& rule, bool inside, ir::Rule& result);
  void refuse(Span span, std::string message, std::string help);

  const SourceMap& sources_;
  const Names& names_;
  Expressions& expressions_;
  Statements& statements_;
  Diagnostics& diagnostics_;
};

}  // namespace robosync::compiler
