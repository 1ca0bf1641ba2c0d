// textDocument/documentSymbol: the outline of a program.
#include "compiler/query/outline.hpp"

#include <utility>

#include "compiler/syntax/parser.hpp"
#include "rsc/lsp/answers.hpp"

namespace robosync::tool::lsp {

namespace query = compiler::query;
using compiler::SourceMap;

namespace {

// SymbolKind of the protocol.
int symbol_kind(query::OutlineKind kind) {
  constexpr int kNamespace = 3, kClass = 5, kMethod = 6, kFunction = 12, kVariable = 13,
                kConstant = 14, kEvent = 24;
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
    case query::OutlineKind::test:
      break;
  }
  return kMethod;
}

Json symbol_json(const query::OutlineItem& item, const SourceMap& sources, Encoding encoding) {
  Json inside = Json::array();
  for (const query::OutlineItem& one : item.inside)
    inside.push_back(symbol_json(one, sources, encoding));
  return {{"name", item.name},
          {"kind", symbol_kind(item.kind)},
          {"range", range_json(sources, item.span, encoding)},
          {"selectionRange", range_json(sources, item.name_span, encoding)},
          {"children", std::move(inside)}};
}

void add_flat(const query::OutlineItem& item, const std::string& uri, const std::string& inside_of,
              const SourceMap& sources, Encoding encoding, Json& result) {
  result.push_back(
      {{"name", item.name},
       {"kind", symbol_kind(item.kind)},
       {"location", {{"uri", uri}, {"range", range_json(sources, item.span, encoding)}}},
       {"containerName", inside_of}});
  for (const query::OutlineItem& one : item.inside)
    add_flat(one, uri, item.name, sources, encoding, result);
}

}  // namespace

Json document_symbols(Desk desk, const Json& params) {
  const std::string uri = address_in(params);
  const Document* const document = desk.workspace.find(uri);
  if (document == nullptr || name_of(uri).ends_with(".json")) return nullptr;
  SourceMap sources;
  compiler::Diagnostics ignored;
  const compiler::FileId file = sources.add("", std::string(document->source.text()));
  const compiler::ast::Tree tree = compiler::parse(sources, file, ignored);
  Json result = Json::array();
  for (const query::OutlineItem& item : query::outline(tree, sources)) {
    if (desk.client.nested_symbols)
      result.push_back(symbol_json(item, sources, desk.workspace.encoding()));
    else
      add_flat(item, uri, "", sources, desk.workspace.encoding(), result);
  }
  return result;
}

}  // namespace robosync::tool::lsp
