// textDocument/formatting: the text in the standard style.
#include <algorithm>
#include <optional>
#include <string>

#include "rsc/lsp/answers.hpp"
#include "rsc/lsp/uris.hpp"
#include "rsc/text_format.hpp"

namespace robosync::tool::lsp {

using compiler::SourceFile, compiler::SourceMap;

namespace {

// The difference of two texts as one change of whole lines.
Json difference(const SourceFile& before, std::string_view after, Encoding encoding) {
  const std::string_view text = before.text();
  const auto first =
      static_cast<std::size_t>(std::ranges::mismatch(text, after).in1 - text.begin());
  const std::size_t shorter = std::min(text.size(), after.size());
  std::size_t tail = 0;
  while (tail < shorter - first && text[text.size() - 1 - tail] == after[after.size() - 1 - tail])
    ++tail;
  // Only whole lines, so that no code point or line end is split.
  const std::size_t begin = first == 0 ? 0 : text.rfind('\n', first - 1) + 1;
  const std::size_t next = text.find('\n', std::max(begin, text.size() - tail));
  const std::size_t end = next == std::string_view::npos ? text.size() : next + 1;
  const std::size_t kept = text.size() - end;
  return {{"range", range_json(before, static_cast<std::uint32_t>(begin),
                               static_cast<std::uint32_t>(end), encoding)},
          {"newText", after.substr(begin, after.size() - kept - begin)}};
}

// Nothing if the text has errors, which are shown already.
std::optional<std::string> formatted(const Document& document) {
  SourceMap sources;
  compiler::Diagnostics diagnostics;
  const compiler::FileId file =
      sources.add(name_of(document.uri), std::string(document.source.text()));
  auto result = tool::formatted(sources, file, diagnostics);
  if (diagnostics.errors() > 0) return std::nullopt;
  if (!result) throw Refusal("this text cannot be formatted without changing its meaning");
  return result;
}

}  // namespace

Json formatting(Desk desk, const Json& params) {
  const Document* const document = desk.workspace.find(address_in(params));
  if (document == nullptr) throw Refusal("this text is not open");
  const std::optional<std::string> result = formatted(*document);
  if (!result) return nullptr;
  if (*result == document->source.text()) return Json::array();
  return Json::array({difference(document->source, *result, desk.workspace.encoding())});
}

}  // namespace robosync::tool::lsp
