// The part of Collector that walks over the trees.
#include "compiler/syntax/walk.hpp"

#include <algorithm>

#include "compiler/query/collector.hpp"

namespace robosync::compiler::query {
namespace {

// Visits the direct parts of an expression.
template <typename Node, typename Visit>
void for_each_part(const Node& node, const Visit& visit) {
  if constexpr (requires { node.value; }) visit(node.value);
  if constexpr (requires { node.left; }) visit(node.left);
  if constexpr (requires { node.right; }) visit(node.right);
  if constexpr (requires { node.low; }) visit(node.low);
  if constexpr (requires { node.high; }) visit(node.high);
  if constexpr (requires { node.first; }) visit(node.first);
  if constexpr (requires { node.second; }) visit(node.second);
  if constexpr (requires { node.by; }) visit(node.by);
  if constexpr (requires { node.condition; }) visit(node.condition);
  if constexpr (requires { node.duration; }) visit(node.duration);
  if constexpr (requires { node.within; }) visit(node.within);
  if constexpr (requires { node.index; }) visit(node.index);
  if constexpr (requires { visit(node.times); }) visit(node.times);
}

}  // namespace

void Collector::expr(const ast::Box<ast::Expr>& expr) {
  if (expr == nullptr) return;
  const auto parts = [this](const ast::Box<ast::Expr>& part) { this->expr(part); };
  std::visit(
      [&](const auto& node) {
        leaf(node);
        for_each_part(node, parts);
      },
      expr->node);
}

// ---- items

void Collector::item(const ast::Item& item) {
  std::visit([this](const auto& node) { add(node); }, item.node);
}

void Collector::add(const ast::Use& node) {
  const std::string built_in = "<" + std::string(node.module.text) + ">";
  for (std::size_t id = kConfigurationFile + 1; id < project_.sources.size(); ++id) {
    const std::string& name = project_.sources.file(static_cast<FileId>(id)).name();
    if (node.is_string ? !name.ends_with(node.module.text) : !same_name(name, built_in)) continue;
    refer(node.module, {SymbolKind::module, std::string(node.module.text),
                        Span{static_cast<FileId>(id), 0, 0}, false});
    return;
  }
}

void Collector::add(const ast::Let& node) {
  declare(SymbolKind::let, node.name);
  expr(node.value);
}

void Collector::add(const ast::Remember& node) {
  declare(SymbolKind::remember, node.name, within_);
  expr(node.value);
}

void Collector::add(const ast::State& node) {
  declare(SymbolKind::state, node.name);
  for (const ast::Name& one : node.labels)
    declare(SymbolKind::label, one, node.name.text);
}

void Collector::add(const ast::Timer& node) {
  declare(SymbolKind::timer, node.name);
}

void Collector::add(const ast::List& node) {
  declare(SymbolKind::list, node.name);
  arguments(node.items);
}

void Collector::add(const ast::Feeling& node) {
  declare(SymbolKind::feeling, node.name);
  for (const auto* part : {&node.from, &node.to, &node.start, &node.fades_to, &node.fades_over})
    expr(*part);
}

void Collector::add(const ast::Limit& node) {
  target(node.actuator);
  if (names_.find_sensor(node.actuator.text)) {
    ast::Operand operand{node.actuator, std::make_unique<ast::Name>(node.channel)};
    if (const auto channel = names_.find_channel(operand)) {
      const Spelled& known = names_.channel(*channel).name;
      refer(node.channel,
            {SymbolKind::channel, known.text, known.span, true, channel->sensor, channel->channel});
    }
  }
  expr(node.value);
}

void Collector::add(const ast::Check& node) {
  declare(SymbolKind::check, node.name);
  expr(node.operand);
  for (const ast::Band& band : node.bands) {
    declare(SymbolKind::label, band.label, node.name.text);
    expr(band.low);
    expr(band.high);
  }
  expr(node.margin);
  expr(node.smooth);
}

void Collector::add(const ast::Define& node) {
  declare(SymbolKind::define, node.name);
  within_ = node.name.text;
  parameters_ = &node.parameters;
  for (const ast::Name& one : node.parameters)
    declare(SymbolKind::parameter, one, within_);
  block(node.body);
  parameters_ = nullptr;
  within_ = {};
}

void Collector::add(const ast::Motion& node) {
  declare(SymbolKind::motion, node.name);
  for (const ast::Name& column : node.columns)
    target(column);
  for (const ast::MotionRow& row : node.rows) {
    expr(row.time);
    for (const ast::MotionKey& key : row.keys)
      expr(key.value);
  }
}

void Collector::add(const ast::Behavior& node) {
  declare(SymbolKind::behavior, node.name);
  names_.set_scope(&node);
  within_ = node.name.text;
  for (const ast::Remember& one : node.variables)
    add(one);
  for (const ast::Rule& rule : node.rules)
    add(rule);
  within_ = {};
  names_.set_scope(nullptr);
}

void Collector::modifiers(const ast::Modifiers& node) {
  for (const auto* part : {&node.cooldown, &node.margin, &node.waiting})
    expr(*part);
}

void Collector::add(const ast::Rule& node) {
  std::visit(
      [this](const auto& rule) {
        if constexpr (requires { rule.condition; }) expr(rule.condition);
        if constexpr (requires { rule.period; }) expr(rule.period);
        if constexpr (requires { rule.to; }) expr(rule.to);
      },
      node.node);
  modifiers(node.modifiers);
  ast::for_each_block(node, [this](const ast::Block& one) { block(one); });
}

void Collector::add(const ast::Safety& node) {
  declare(SymbolKind::safety, node.name);
  expr(node.condition);
  modifiers(node.modifiers);
  block(node.body);
  expr(node.resume);
}

void Collector::add(const ast::Test& node) {
  for (const ast::TestStep& one : node.steps)
    std::visit([this](const auto& inner) { step(inner); }, one.node);
}

// ---- statements

template <typename Other>
void Collector::stmt(const Other& node) {
  for_each_part(node, [this](const ast::Box<ast::Expr>& part) { expr(part); });
  ast::for_each_block_of(node, [this](const ast::Block& inner) { block(inner); });
}

void Collector::block(const ast::Block& block) {
  for (const ast::Stmt& one : block)
    std::visit([this](const auto& node) { stmt(node); }, one.node);
}

void Collector::arguments(const std::vector<ast::Argument>& arguments) {
  for (const ast::Argument& argument : arguments) {
    if (const auto* amount = std::get_if<ast::Amount>(&argument.value)) expr(amount->value);
    const auto* const plain = std::get_if<ast::Word>(&argument.value);
    if (plain == nullptr) continue;
    const ast::Name& name = plain->name;
    if (parameter(name) || target(name) || word(name) || motion(name)) continue;
    value(name);
  }
}

void Collector::stmt(const ast::Command& node) {
  if (!parameter(node.verb) && !verb(node.verb)) define(node.verb);
  arguments(node.arguments);
}

void Collector::stmt(const ast::Call& node) {
  if (!parameter(node.name)) define(node.name);
  for (const ast::Argument& argument : node.arguments) {
    const auto* amount = std::get_if<ast::Amount>(&argument.value);
    if (amount == nullptr || amount->value == nullptr) continue;
    // The name of an actuator or of another DEFINE is an operand here, too.
    const auto* operand = std::get_if<ast::Operand>(&amount->value->node);
    if (operand != nullptr && !operand->channel && define(operand->name)) continue;
    expr(amount->value);
  }
}

void Collector::stmt(const ast::Set& node) {
  if (!variable(node.name)) value(node.name);
  const auto* operand = node.value ? std::get_if<ast::Operand>(&node.value->node) : nullptr;
  if (operand != nullptr) {
    std::string text(operand->name.text);
    if (operand->channel) text += " " + std::string(operand->channel->text);
    const Labels labels = labels_of({node.name, nullptr});
    if (label(labels, {text, node.value->span})) return;
  }
  expr(node.value);
}

void Collector::stmt(const ast::Raise& node) {
  value(node.name);
  expr(node.by);
}

void Collector::stmt(const ast::Stop& node) {
  if (node.name) value(*node.name);
}

void Collector::stmt(const ast::Signal& node) {
  if (!parameter(node.name)) variable(node.name);
}

void Collector::stmt(const ast::Log& node) {
  arguments(node.arguments);
}

// ---- TEST

void Collector::step(const ast::TestFeed& node) {
  expr(node.at);
  leaf(node.target);
  const auto* operand = node.value ? std::get_if<ast::Operand>(&node.value->node) : nullptr;
  if (operand != nullptr && label(labels_of(node.target), operand->name)) return;
  expr(node.value);
}

void Collector::step(const ast::ExpectCommand& node) {
  stmt(node.command);
  expr(node.within);
}

void Collector::step(const ast::ExpectThat& node) {
  expr(node.condition);
  expr(node.within);
}

}  // namespace robosync::compiler::query
