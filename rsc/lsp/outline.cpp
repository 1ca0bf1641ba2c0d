// textDocument/documentSymbol: the outline of a program or of a robot.json.
#include "compiler/query/outline.hpp"

#include <utility>

#include "compiler/query/configuration.hpp"
#include "compiler/syntax/parser.hpp"
#include "rsc/lsp/answers.hpp"
#include "rsc/lsp/uris.hpp"

namespace robosync::tool::lsp {

namespace query = compiler::query;
using compiler::SourceMap;

namespace {

// SymbolKind of the protocol.
int symbol_kind(query::OutlineKind kind) {
  constexpr int kNamespace = 3, kClass = 5, kMethod = 6, kField = 8, kFunction = 12, kVariable = 13,
                kConstant = 14, kArray = 18, kObject = 19, kEvent = 24;
  switch (kind) {
    case query::OutlineKind::constant:
      return kConstant;
    case query::OutlineKind::variable:
      return kVariable;
    case query::OutlineKind::block:
      return kNamespace;
    case query::OutlineKind::define:
      return kFunction;
    case query::OutlineKind::behavior:
      return kClass;
    case query::OutlineKind::rule:
      return kEvent;
    case query::OutlineKind::part:
      return kObject;
    case query::OutlineKind::channel:
      return kField;
    case query::OutlineKind::list:
      return kArray;
    case query::OutlineKind::test:
      break;
  }
  return kMethod;
}

// Adds items to a list.
class Symbols {
public:
  Symbols(Desk desk, std::string uri, const SourceMap& sources)
      : desk_(desk), uri_(std::move(uri)), sources_(sources) {}

  void add(const query::OutlineItem& item, const std::string& outside, Json& list) const {
    Json symbol;
    symbol["name"] = item.name;
    symbol["kind"] = symbol_kind(item.kind);
    if (desk_.client.nested_symbols) {
      symbol["range"] = range(item.span);
      symbol["selectionRange"] = range(item.name_span);
      add_all(item.inside, "", symbol["children"] = Json::array());
      list.push_back(std::move(symbol));
    } else {
      symbol["location"]["uri"] = uri_;
      symbol["location"]["range"] = range(item.span);
      symbol["containerName"] = outside;
      list.push_back(std::move(symbol));
      add_all(item.inside, item.name, list);
    }
  }
  void add_all(const std::vector<query::OutlineItem>& items, const std::string& outside,
               Json& list) const {
    for (const query::OutlineItem& item : items)
      add(item, outside, list);
  }

private:
  [[nodiscard]] Json range(compiler::Span span) const {
    return range_json(sources_, span, desk_.workspace.encoding());
  }

  Desk desk_;
  std::string uri_;
  const SourceMap& sources_;
};

std::vector<query::OutlineItem> items_of(const SourceMap& sources, compiler::FileId file,
                                         bool is_json) {
  if (is_json) return query::outline_configuration(sources.file(file), file);
  compiler::Diagnostics ignored;
  return query::outline(compiler::parse(sources, file, ignored), sources);
}

}  // namespace

Json document_symbols(Desk desk, const Json& params) {
  const std::string uri = address_in(params);
  const Document* const document = desk.workspace.find(uri);
  const auto path = path_of(uri);
  const bool is_json = name_of(uri).ends_with(".json");
  // Not every JSON that is open describes a robot.
  if (document == nullptr || (is_json && (!path || desk.workspace.users_of(*path).empty())))
    return nullptr;
  SourceMap sources;
  const compiler::FileId file = sources.add("", std::string(document->source.text()));
  Json result = Json::array();
  Symbols(desk, uri, sources).add_all(items_of(sources, file, is_json), "", result);
  return result;
}

}  // namespace robosync::tool::lsp
