// textDocument/semanticTokens/full and textDocument/foldingRange.
#include <array>
#include <string_view>

#include "compiler/query/tokens.hpp"
#include "rsc/lsp/answers.hpp"
#include "rsc/lsp/uris.hpp"

namespace robosync::tool::lsp {

namespace query = compiler::query;
using compiler::SourceMap;

namespace {

enum class Type : std::uint8_t {
  keyword,
  number,
  string,
  variable,
  constant,
  function,
  parameter,
  property,
  member,
  block
};
// Their names in the protocol; a constant is a read-only variable.
constexpr std::array<std::string_view, 10> kTypes = {
    "keyword",  "number",    "string",   "variable",   "variable",
    "function", "parameter", "property", "enumMember", "class"};
constexpr unsigned kDeclaration = 1, kReadOnly = 2;  // bits, in the order of the legend

Type type_of(query::SymbolKind kind) {
  using K = query::SymbolKind;
  switch (kind) {
    case K::let:
    case K::list:
      return Type::constant;
    case K::define:
    case K::motion:
    case K::function:
    case K::verb:
      return Type::function;
    case K::parameter:
      return Type::parameter;
    case K::sensor:
    case K::channel:
    case K::actuator:
    case K::group:
      return Type::property;
    case K::label:
    case K::word:
      return Type::member;
    case K::behavior:
    case K::safety:
    case K::module:
      return Type::block;
    default:
      return Type::variable;
  }
}

Type type_of(const query::ColouredToken& token) {
  switch (token.sort) {
    case query::ColouredToken::Sort::keyword:
      return Type::keyword;
    case query::ColouredToken::Sort::number:
      return Type::number;
    case query::ColouredToken::Sort::text:
      return Type::string;
    case query::ColouredToken::Sort::name:
      break;
  }
  return type_of(*token.meaning);
}

}  // namespace

Json colour_legend() {
  return {{"tokenTypes", kTypes}, {"tokenModifiers", {"declaration", "readonly"}}};
}

// Five numbers per token: lines since the last token, characters since it or since the start of the line, length, type,
// modifiers.
Json semantic_tokens(Desk desk, const Json& params) {
  const auto path = path_of(address_in(params));
  const auto users = path ? desk.workspace.users_of(*path) : std::vector<const Checked*>();
  if (users.empty() || path->extension() == ".json") return nullptr;
  const Checked& checked = *users.front();
  const SourceMap& sources = checked.result().sources;
  const compiler::FileId file = checked.file(*path).value();
  const Encoding encoding = desk.workspace.encoding();
  Json data = Json::array();
  Place last;
  for (const query::ColouredToken& token :
       query::coloured_tokens(sources, file, checked.symbols())) {
    const Place place = place_of(sources.file(file), token.span.begin, encoding);
    const Type type = type_of(token);
    const bool same_line = place.line == last.line;
    data.push_back(place.line - last.line);
    data.push_back(same_line ? place.character - last.character : place.character);
    data.push_back(units_in(sources.text(token.span), encoding));
    data.push_back(static_cast<unsigned>(type));
    data.push_back((token.declares ? kDeclaration : 0U) |
                   (type == Type::constant ? kReadOnly : 0U));
    last = place;
  }
  return {{"data", std::move(data)}};
}

Json folding_ranges(Desk desk, const Json& params) {
  const Document* const document = desk.workspace.find(address_in(params));
  if (document == nullptr || name_of(document->uri).ends_with(".json")) return nullptr;
  SourceMap sources;
  const compiler::FileId file = sources.add("", std::string(document->source.text()));
  Json result = Json::array();
  for (const query::Fold& fold : query::folds(sources, file))
    result.push_back({{"startLine", fold.first - 1}, {"endLine", fold.last - 1}});
  return result;
}

}  // namespace robosync::tool::lsp
