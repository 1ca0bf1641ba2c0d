// Translates rules: what triggers them, their modifiers, and SAFETY.
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

  // What is wrong is reported. `inside`: of a BEHAVIOR.
  [[nodiscard]] ProgramRule translate(const ast::Rule& rule, bool inside);
  [[nodiscard]] ProgramRule translate(const ast::Safety& safety, Span span);

private:
  void translate(const ast::Rule& rule, const ast::WhenRule& node, ProgramRule& result);
  void translate(const ast::Rule& rule, const ast::WhileRule& node, ProgramRule& result);
  void translate(const ast::Rule& rule, const ast::EveryRule& node, ProgramRule& result);
  void translate(const ast::Rule& rule, const ast::AtStartRule& node, ProgramRule& result);
  Expression period(const ast::EveryRule& node);
  void modify(const ast::Rule& rule, bool inside, ProgramRule& result);
  void refuse(Span span, std::string message, std::string help);

  const SourceMap& sources_;
  const Names& names_;
  Expressions& expressions_;
  Statements& statements_;
  Diagnostics& diagnostics_;
};

}  // namespace robosync::compiler
