// textDocument/completion: what can be written at a position.
#include "compiler/query/completion.hpp"

#include <utility>

#include "compiler/query/configuration.hpp"
#include "rsc/lsp/answers.hpp"

namespace robosync::tool::lsp {

namespace query = compiler::query;
using compiler::SourceFile, compiler::SourceMap, compiler::Span;

namespace {

// CompletionItemKind of the protocol.
int item_kind(const query::Candidate& candidate) {
  constexpr int kFunction = 3, kField = 5, kVariable = 6, kModule = 9, kUnit = 11, kValue = 12,
                kKeyword = 14, kReference = 18, kEnumMember = 20, kConstant = 21, kEvent = 23;
  using K = query::SymbolKind;
  if (!candidate.kind) return kKeyword;
  switch (*candidate.kind) {
    case K::define:
    case K::motion:
    case K::function:
    case K::verb:
      return kFunction;
    case K::let:
      return kConstant;
    case K::label:
      return kEnumMember;
    case K::signal:
      return kEvent;
    case K::module:
      return kModule;
    case K::sensor:
    case K::actuator:
    case K::group:
      return kReference;
    case K::channel:
      return kField;
    case K::word:
      return candidate.is_text ? kValue : kUnit;
    default:
      return kVariable;
  }
}

Json item_json(const query::Candidate& candidate, const Json& range, char quote,
               const Client& client) {
  std::string text = candidate.text;
  if (candidate.is_text) text = quote + text + quote;
  Json item;
  item["label"] = candidate.text;
  item["kind"] = item_kind(candidate);
  item["sortText"] = (candidate.kind ? "0" : "1") + candidate.text;
  item["filterText"] = text;
  item["textEdit"]["range"] = range;
  item["textEdit"]["newText"] = text;
  if (!candidate.detail.empty()) item["detail"] = candidate.detail;
  if (candidate.text_about.empty()) return item;
  item["documentation"]["kind"] = client.markdown ? "markdown" : "plaintext";
  item["documentation"]["value"] = candidate.text_about;
  return item;
}

char sign_at(const SourceFile& source, std::size_t place) {
  return place < source.text().size() ? source.text()[place] : '\0';
}

// Editors insert the closing quote with the opening one: then it is replaced, too.
Span with_closing_quote(const SourceFile& source, Span typed, char quote) {
  if (typed.end > typed.begin && sign_at(source, typed.begin) == quote &&
      sign_at(source, typed.end) == quote)
    ++typed.end;
  return typed;
}

}  // namespace

Json completion(Desk desk, const Json& params) {
  const auto asked = asked_at(desk, params);
  if (!asked) return nullptr;
  const SourceMap& sources = asked->checked->result().sources;
  const SourceFile& source = sources.file(asked->file);
  const bool is_program = asked->file != compiler::kConfigurationFile;
  const query::Completion found =
      is_program ? query::complete(asked->checked->project(), asked->checked->symbols(),
                                   asked->file, asked->offset)
                 : query::complete_configuration(source, asked->file, asked->offset);
  const char quote = is_program && sign_at(source, found.typed.begin) == '\'' ? '\'' : '"';
  const Span typed = is_program ? with_closing_quote(source, found.typed, quote) : found.typed;
  const Json range = range_json(sources, typed, desk.workspace.encoding());
  Json items = Json::array();
  for (const query::Candidate& candidate : found.candidates)
    items.push_back(item_json(candidate, range, quote, desk.client));
  Json result;
  result["isIncomplete"] = false;
  result["items"] = std::move(items);
  return result;
}

}  // namespace robosync::tool::lsp
