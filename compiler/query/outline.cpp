#include "compiler/query/outline.hpp"

#include <utility>

namespace robosync::compiler::query {
namespace {

class Outliner {
public:
  explicit Outliner(const SourceMap& sources) : sources_(sources) {}

  [[nodiscard]] OutlineItem item(const ast::Item& item) const {
    OutlineItem result =
        std::visit([&](const auto& node) { return of(node, item.span); }, item.node);
    result.span = item.span;
    return result;
  }

private:
  [[nodiscard]] static OutlineItem named(std::string_view keyword, const ast::Name& name,
                                         OutlineKind kind, Span span) {
    const bool has_name = !name.text.empty();
    return {std::string(keyword) + (has_name ? " " + std::string(name.text) : ""),
            kind,
            span,
            has_name ? name.span : span,
            {}};
  }
  // An item that is named by its first line.
  [[nodiscard]] OutlineItem headed(OutlineKind kind, Span span) const {
    const SourceFile& source = sources_.file(span.file);
    const std::string_view text = source.text(span);
    const std::string_view line = text.substr(0, text.find_first_of("\r\n%#"));
    const std::size_t length = line.find_last_not_of(" \t") + 1;
    const auto end = static_cast<std::uint32_t>(span.begin + length);
    return {std::string(line.substr(0, length)), kind, span, {span.file, span.begin, end}, {}};
  }
  [[nodiscard]] OutlineItem of(const ast::Use& node, Span span) const {
    return named("USE", node.module, OutlineKind::block, span);
  }
  [[nodiscard]] OutlineItem of(const ast::Let& node, Span span) const {
    return named("LET", node.name, OutlineKind::constant, span);
  }
  [[nodiscard]] OutlineItem of(const ast::Remember& node, Span span) const {
    return named("REMEMBER", node.name, OutlineKind::variable, span);
  }
  [[nodiscard]] OutlineItem of(const ast::State& node, Span span) const {
    return named("STATE", node.name, OutlineKind::variable, span);
  }
  [[nodiscard]] OutlineItem of(const ast::Timer& node, Span span) const {
    return named("TIMER", node.name, OutlineKind::variable, span);
  }
  [[nodiscard]] OutlineItem of(const ast::List& node, Span span) const {
    return named("LIST", node.name, OutlineKind::constant, span);
  }
  [[nodiscard]] OutlineItem of(const ast::Feeling& node, Span span) const {
    return named("FEELING", node.name, OutlineKind::variable, span);
  }
  [[nodiscard]] OutlineItem of(const ast::Limit& node, Span span) const {
    return named("LIMIT", node.actuator, OutlineKind::block, span);
  }
  [[nodiscard]] OutlineItem of(const ast::Check& node, Span span) const {
    return named("CHECK", node.name, OutlineKind::variable, span);
  }
  [[nodiscard]] OutlineItem of(const ast::Define& node, Span span) const {
    return named("DEFINE", node.name, OutlineKind::define, span);
  }
  [[nodiscard]] OutlineItem of(const ast::Motion& node, Span span) const {
    return named("MOTION", node.name, OutlineKind::define, span);
  }
  [[nodiscard]] OutlineItem of(const ast::Safety& node, Span span) const {
    return named("SAFETY", node.name, OutlineKind::behavior, span);
  }
  [[nodiscard]] OutlineItem of(const ast::Behavior& node, Span span) const {
    OutlineItem result = named("BEHAVIOR", node.name, OutlineKind::behavior, span);
    for (const ast::Remember& variable : node.variables)
      result.inside.push_back(
          named("REMEMBER", variable.name, OutlineKind::variable, variable.name.span));
    for (const ast::Rule& rule : node.rules)
      result.inside.push_back(of(rule, rule.span));
    return result;
  }
  [[nodiscard]] OutlineItem of(const ast::Rule&, Span span) const {
    return headed(OutlineKind::rule, span);
  }
  [[nodiscard]] OutlineItem of(const ast::Test&, Span span) const {
    return headed(OutlineKind::test, span);
  }

  const SourceMap& sources_;
};

}  // namespace

std::vector<OutlineItem> outline(const ast::Tree& tree, const SourceMap& sources) {
  const Outliner outliner(sources);
  std::vector<OutlineItem> result;
  for (const ast::Item& item : tree.items)
    result.push_back(outliner.item(item));
  return result;
}

}  // namespace robosync::compiler::query
