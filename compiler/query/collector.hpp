// Walks over the trees and collects Symbols.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include "compiler/query/symbols.hpp"

namespace robosync::compiler::query {

class Collector {
public:
  explicit Collector(const Project& project);
  void collect();

  std::vector<Symbol> symbols;
  std::vector<Occurrence> occurrences;

private:
  using Key = std::tuple<FileId, std::uint32_t, std::string>;

  // ---- symbols
  std::size_t intern(Symbol symbol);
  void declare(SymbolKind kind, const ast::Name& name, std::string_view within = {});
  void refer(const ast::Name& name, Symbol symbol);
  void collect_robot();
  void collect_references();
  void refer_to(SymbolKind kind, const Spelled& name, std::size_t owner, Span place);
  void collect_behaviors();

  // ---- looking up; false: the name is not of this kind
  bool parameter(const ast::Name& name);
  bool constant(const ast::Name& name);
  bool variable(const ast::Name& name);
  bool list(const ast::Name& name);
  bool motion(const ast::Name& name);
  bool define(const ast::Name& name);
  bool target(const ast::Name& name);
  bool verb(const ast::Name& name);
  bool word(const ast::Name& name);
  bool function(const ast::Name& name);
  void value(const ast::Name& name);

  // ---- labels
  struct Labels {
    std::vector<std::string> texts;
    std::vector<Span> places;  // of a STATE or CHECK; otherwise empty
    std::optional<Span> owner_place;
    std::string owner;
  };
  [[nodiscard]] Labels labels_of(const ast::Operand& operand);
  bool label(const Labels& labels, const ast::Name& name);
  void label_of(const ast::Expr* value, const ast::Name& name);

  // ---- trees
  void item(const ast::Item& item);
  void add(const ast::Use& node);
  void add(const ast::Let& node);
  void add(const ast::Remember& node);
  void add(const ast::State& node);
  void add(const ast::Timer& node);
  void add(const ast::List& node);
  void add(const ast::Feeling& node);
  void add(const ast::Limit& node);
  void add(const ast::Check& node);
  void add(const ast::Define& node);
  void add(const ast::Motion& node);
  void add(const ast::Behavior& node);
  void add(const ast::Rule& node);
  void add(const ast::Safety& node);
  void add(const ast::Test& node);
  void modifiers(const ast::Modifiers& node);

  void block(const ast::Block& block);
  void stmt(const ast::Command& node);
  void stmt(const ast::Call& node);
  void stmt(const ast::Set& node);
  void stmt(const ast::Raise& node);
  void stmt(const ast::Stop& node);
  void stmt(const ast::Signal& node);
  void stmt(const ast::Log& node);
  template <typename Other>
  void stmt(const Other& node);  // has no names of its own
  void step(const ast::TestFeed& node);
  void step(const ast::ExpectCommand& node);
  void step(const ast::ExpectText& node) { expr(node.within); }
  void step(const ast::ExpectNothing& node) { expr(node.duration); }
  void step(const ast::ExpectThat& node);
  void step(const ast::Wait& node) { expr(node.duration); }
  void step(const ast::Seed&) {}
  void arguments(const std::vector<ast::Argument>& arguments);

  void expr(const ast::Box<ast::Expr>& expr);
  void leaf(const ast::Operand& node);
  void leaf(const ast::Function& node) { function(node.name); }
  void leaf(const ast::ItemOf& node) { list(node.list); }
  void leaf(const ast::CountOf& node) { list(node.list); }
  void leaf(const ast::Is& node);
  void leaf(const ast::Becomes& node) { label_of(node.value.get(), node.label); }
  template <typename Other>
  void leaf(const Other&) {}

  const Project& project_;
  Diagnostics ignored_;
  Names names_;
  std::map<Key, std::size_t> known_;
  const std::vector<ast::Name>* parameters_ = nullptr;
  std::string_view within_;  // the BEHAVIOR or DEFINE
};

}  // namespace robosync::compiler::query
