// Requests about a name: what it is, and where it is declared and used.
#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "compiler/query/configuration.hpp"
#include "compiler/query/describe.hpp"
#include "rsc/lsp/meant.hpp"

namespace robosync::tool::lsp {

namespace query = compiler::query;
using compiler::SourceFile, compiler::SourceMap, compiler::Span;

namespace {

// ---- hover

std::string markdown(const query::Description& about, const std::string& name) {
  std::string text = fmt::format("**{}**, {}", name, about.kind);
  if (!about.code.empty()) text += fmt::format("\n\n```rsl\n{}\n```", about.code);
  if (about.text.empty()) return text;
  text += "\n\n";
  for (const char c : about.text)
    text += c == '\n' ? std::string("  \n") : std::string(1, c);
  return text;
}

std::string plain(const query::Description& about, const std::string& name) {
  std::string text = fmt::format("{}, {}", name, about.kind);
  if (!about.code.empty()) text += "\n" + about.code;
  if (!about.text.empty()) text += "\n" + about.text;
  return text;
}

// "Used at `robot.rsl:3` and `robot.rsl:7`.": where the programs say a name of robot.json.
std::string uses_of(const std::vector<Meant>& everywhere) {
  std::vector<std::string> uses;
  for (const Meant& meant : everywhere)
    for (const query::Occurrence& one : places_of(meant)) {
      const SourceFile& source = sources_of(meant.asked).file(one.span.file);
      std::string use =
          fmt::format("{}:{}", std::string_view(source.name()).substr(source.name().rfind('/') + 1),
                      source.line_of(one.span.begin));
      const bool is_new = std::ranges::find(uses, use) == uses.end();
      if (one.span.file != compiler::kConfigurationFile && is_new) uses.push_back(std::move(use));
    }
  return uses.empty() ? "" : fmt::format("\nUsed at {}.", compiler::list_names(uses));
}

Json hover_json(const std::string& value, bool is_markdown, const Json& range) {
  Json result;
  result["contents"]["kind"] = is_markdown ? "markdown" : "plaintext";
  result["contents"]["value"] = value;
  if (!range.is_null()) result["range"] = range;
  return result;
}

Json hover_json(Desk desk, const query::Described& what, const Asked& asked) {
  const bool is_markdown = desk.client.markdown;
  return hover_json(is_markdown ? markdown(what.about, what.name) : plain(what.about, what.name),
                    is_markdown,
                    range_json(sources_of(asked), what.span, desk.workspace.encoding()));
}

}  // namespace

Json hover(Desk desk, const Json& params) {
  const auto asked = asked_at(desk, params);
  if (!asked) return nullptr;
  const query::Project project = asked->checked->project();
  const bool in_robot = asked->file == compiler::kConfigurationFile;
  if (const auto meant = meant_by(*asked)) {
    query::Description about = query::describe(*meant->symbol, project);
    if (in_robot) about.text += uses_of(meant_here(desk, params));
    return hover_json(desk, {meant->symbol->name, meant->name->span, std::move(about)}, *asked);
  }
  if (in_robot) {
    const auto found = query::describe_configuration(sources_of(*asked).file(asked->file),
                                                     asked->file, asked->offset, project.robot);
    return found.name.empty() ? nullptr : hover_json(desk, found, *asked);
  }
  std::string rule = query::rule_in_english(project, asked->file, asked->offset);
  if (rule.empty()) return nullptr;
  const compiler::Result& result = asked->checked->result();
  const auto costs = costs_by_line(result, asked->file);
  const auto cost = costs.find(result.sources.file(asked->file).line_of(asked->offset));
  if (cost != costs.end())
    rule += fmt::format("It costs at most {} instructions in a step.\n", cost->second);
  const bool is_markdown = desk.client.markdown;
  return hover_json(is_markdown ? "```text\n" + rule + "```" : rule, is_markdown, nullptr);
}

Json definition(Desk desk, const Json& params) {
  const auto all = meant_here(desk, params);
  if (all.empty() || !all.front().symbol->declared) return nullptr;
  const SourceMap& sources = sources_of(all.front().asked);
  const Span declared = *all.front().symbol->declared;
  return location_json(sources, without_quotes(sources, declared), desk.workspace);
}

namespace {

void add_new(Json& list, Json item) {
  if (std::ranges::find(list, item) == list.end()) list.push_back(std::move(item));
}

}  // namespace

Json references(Desk desk, const Json& params) {
  const bool declarations = params.at("context").at("includeDeclaration").get<bool>();
  Json result = Json::array();
  for (const Meant& meant : meant_everywhere(desk, params)) {
    const SourceMap& sources = sources_of(meant.asked);
    for (const query::Occurrence& one : places_of(meant)) {
      if (one.declares && !declarations) continue;
      Json location = location_json(sources, without_quotes(sources, one.span), desk.workspace);
      if (!location.is_null()) add_new(result, std::move(location));
    }
  }
  return result;
}

// In this text only.
Json highlights(Desk desk, const Json& params) {
  constexpr int kRead = 2, kWrite = 3;
  Json result = Json::array();
  for (const Meant& meant : meant_here(desk, params)) {
    const SourceMap& sources = sources_of(meant.asked);
    for (const query::Occurrence& one : places_of(meant)) {
      if (one.span.file != meant.asked.file) continue;
      const Span span = without_quotes(sources, one.span);
      add_new(result, {{"range", range_json(sources, span, desk.workspace.encoding())},
                       {"kind", one.declares ? kWrite : kRead}});
    }
  }
  return result;
}

}  // namespace robosync::tool::lsp
