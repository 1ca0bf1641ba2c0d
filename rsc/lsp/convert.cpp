#include "rsc/lsp/convert.hpp"

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "rsc/lsp/library.hpp"
#include "rsc/lsp/uris.hpp"

namespace robosync::tool::lsp {

using compiler::Diagnostic, compiler::Label, compiler::SourceFile, compiler::SourceMap,
    compiler::Span;

Place place_in(const Json& position) {
  return {position.at("line").get<std::uint32_t>(), position.at("character").get<std::uint32_t>()};
}

// Key by key: a list of keys and values would make several times the code.
Json position_json(Place place) {
  Json position;
  position["line"] = place.line;
  position["character"] = place.character;
  return position;
}

Json range_json(const SourceFile& source, std::uint32_t begin, std::uint32_t end,
                Encoding encoding) {
  Json range;
  range["start"] = position_json(place_of(source, begin, encoding));
  range["end"] = position_json(place_of(source, std::max(begin, end), encoding));
  return range;
}

Json range_json(const SourceMap& sources, Span span, Encoding encoding) {
  return range_json(sources.file(span.file), span.begin, span.end, encoding);
}

Span without_quotes(const SourceMap& sources, Span span) {
  const std::string_view text = sources.text(span);
  const bool quoted = span.file == compiler::kConfigurationFile && text.size() > 1 &&
                      text.front() == '"' && text.back() == '"';
  return quoted ? Span{span.file, span.begin + 1, span.end - 1} : span;
}

std::optional<std::string> address_of(const std::string& name, const Workspace& workspace) {
  if (name.starts_with('<')) {
    const auto path = library_file(name);
    return path ? std::optional(uri_of(*path)) : std::nullopt;
  }
  const std::filesystem::path path(name);
  if (const Document* const document = workspace.find(path)) return document->uri;
  return path.is_absolute() ? std::optional(uri_of(path)) : std::nullopt;
}

Json location_json(const SourceMap& sources, Span span, const Workspace& workspace) {
  const auto uri = address_of(sources.file(span.file).name(), workspace);
  if (!uri) return nullptr;
  Json location;
  location["uri"] = *uri;
  location["range"] = range_json(sources, span, workspace.encoding());
  return location;
}

// ---- diagnostics

namespace {

int severity_of(compiler::Level level) {
  constexpr std::array<int, 3> kSeverities = {1, 2, 3};  // error, warning, information
  return kSeverities.at(static_cast<std::size_t>(level));
}

// The label at which it is shown: the first one in a file that is not part of rsc.
const Label* anchor_of(const Diagnostic& diagnostic, const SourceMap& sources) {
  const auto is_shown = [&](const Label& label, bool primary) {
    return label.primary == primary && !sources.file(label.span.file).name().starts_with('<');
  };
  for (const bool primary : {true, false})
    for (const Label& label : diagnostic.labels)
      if (is_shown(label, primary)) return &label;
  return nullptr;
}

std::string message_of(const Diagnostic& diagnostic, const Label& anchor) {
  std::string message = diagnostic.message;
  if (!anchor.text.empty()) message += "\n" + anchor.text;
  for (const std::string& help : diagnostic.help)
    message += "\nhelp: " + help;
  return message;
}

// The other labels, for an editor that jumps to them, or as words.
void add_related(const Diagnostic& diagnostic, const Label& anchor, const SourceMap& sources,
                 const Workspace& workspace, const Client& client, Json& result) {
  Json related = Json::array();
  std::string words;
  for (const Label& label : diagnostic.labels) {
    if (&label == &anchor) continue;
    const SourceFile& file = sources.file(label.span.file);
    Json location = location_json(sources, label.span, workspace);
    const std::string text = label.text.empty() ? "see here" : label.text;
    words += fmt::format("\n{}:{}: {}", file.name(), file.line_of(label.span.begin), text);
    if (!location.is_null())
      related.push_back({{"location", std::move(location)}, {"message", text}});
  }
  if (client.related_information && !related.empty())
    result["relatedInformation"] = std::move(related);
  else if (!client.related_information)
    result["message"] = result["message"].get<std::string>() + words;
}

}  // namespace

namespace {

std::optional<Finding> finding_at(const Label& anchor, const Diagnostic& diagnostic,
                                  const Checked& checked, const Workspace& workspace,
                                  const Client& client) {
  const SourceMap& sources = checked.result().sources;
  const auto uri = address_of(sources.file(anchor.span.file).name(), workspace);
  if (!uri) return std::nullopt;
  Json result = {{"range", range_json(sources, anchor.span, workspace.encoding())},
                 {"severity", severity_of(diagnostic.level)},
                 {"code", compiler::code_name(diagnostic.code)},
                 {"source", "rsc"},
                 {"message", message_of(diagnostic, anchor)}};
  add_related(diagnostic, anchor, sources, workspace, client, result);
  return Finding{*uri, std::move(result)};
}

// Errors that a program's use of a module brings up are also shown in the module.
const Label* place_in_module(const Diagnostic& diagnostic, const SourceMap& sources) {
  const Label* const anchor = anchor_of(diagnostic, sources);
  for (const Label& label : diagnostic.labels) {
    const bool is_module = label.span.file > compiler::kConfigurationFile &&
                           !sources.file(label.span.file).name().starts_with('<');
    if (anchor != nullptr && is_module && label.span.file != anchor->span.file) return &label;
  }
  return nullptr;
}

void add(std::optional<Finding> one, Findings& findings) {
  if (!one) return;
  std::vector<Json>& there = findings[one->uri];
  // Two programs may report the same error in a shared robot.json.
  if (std::ranges::find(there, one->diagnostic) == there.end())
    there.push_back(std::move(one->diagnostic));
}

}  // namespace

std::optional<Finding> finding_of(const Diagnostic& diagnostic, const Checked& checked,
                                  const Workspace& workspace, const Client& client) {
  const Label* const anchor = anchor_of(diagnostic, checked.result().sources);
  if (anchor == nullptr) return std::nullopt;
  return finding_at(*anchor, diagnostic, checked, workspace, client);
}

void add_findings(const Checked& checked, const Workspace& workspace, const Client& client,
                  Findings& findings) {
  const SourceMap& sources = checked.result().sources;
  const auto program = address_of(sources.file(compiler::kProgramFile).name(), workspace);
  if (!checked.trouble().empty() && program)
    findings[*program].push_back(
        {{"range", range_json(sources, {compiler::kProgramFile, 0, 0}, workspace.encoding())},
         {"severity", severity_of(compiler::Level::error)},
         {"source", "rsc"},
         {"message", checked.trouble()}});
  for (const Diagnostic& diagnostic : checked.result().diagnostics.all()) {
    add(finding_of(diagnostic, checked, workspace, client), findings);
    if (const Label* const label = place_in_module(diagnostic, sources))
      add(finding_at(*label, diagnostic, checked, workspace, client), findings);
  }
}

}  // namespace robosync::tool::lsp
