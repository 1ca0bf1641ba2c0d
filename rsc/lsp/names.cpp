// Requests about a name: what it is, where it is declared and used, and whether it can be renamed.
#include <algorithm>
#include <map>
#include <utility>

#include <fmt/format.h>

#include "compiler/query/configuration.hpp"
#include "compiler/query/describe.hpp"
#include "compiler/query/rename.hpp"
#include "rsc/lsp/answers.hpp"
#include "rsc/lsp/uris.hpp"

namespace robosync::tool::lsp {

namespace query = compiler::query;
using compiler::SourceFile, compiler::SourceMap;

namespace {

struct Meant {
  Asked asked;
  const query::Occurrence* name = nullptr;  // never null
  const query::Symbol* symbol = nullptr;    // likewise
};

std::optional<Meant> meant_by(const Asked& asked) {
  const query::Symbols& symbols = asked.checked->symbols();
  const query::Occurrence* const name = symbols.at(asked.file, asked.offset);
  if (name == nullptr) return std::nullopt;
  return Meant{asked, name, &symbols.all().at(name->symbol)};
}

std::optional<Meant> meant_at(Desk desk, const Json& params) {
  const auto asked = asked_at(desk, params);
  return asked ? meant_by(*asked) : std::nullopt;
}

// The same position in every program that the text is part of (a robot.json, a module).
std::vector<Meant> meant_everywhere(Desk desk, const Json& params) {
  std::vector<Meant> result;
  const auto first = asked_at(desk, params);
  const auto path = path_of(address_in(params));
  if (!first || !path) return result;
  for (const Checked* const checked : desk.workspace.users_of(*path)) {
    const auto file = checked->file(*path);
    const auto meant = meant_by({checked, file.value(), first->offset});
    if (meant) result.push_back(*meant);
  }
  return result;
}

const SourceMap& sources_of(const Asked& asked) {
  return asked.checked->result().sources;
}

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
    for (const query::Occurrence& one : meant.asked.checked->symbols().of(meant.name->symbol)) {
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
    if (in_robot) about.text += uses_of(meant_everywhere(desk, params));
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
  const auto meant = meant_at(desk, params);
  if (!meant || !meant->symbol->declared) return nullptr;
  const SourceMap& sources = sources_of(meant->asked);
  return location_json(sources, without_quotes(sources, *meant->symbol->declared), desk.workspace);
}

Json references(Desk desk, const Json& params) {
  const bool declarations = params.at("context").at("includeDeclaration").get<bool>();
  Json result = Json::array();
  for (const Meant& meant : meant_everywhere(desk, params)) {
    const SourceMap& sources = sources_of(meant.asked);
    for (const query::Occurrence& one : meant.asked.checked->symbols().of(meant.name->symbol)) {
      if (one.declares && !declarations) continue;
      Json location = location_json(sources, without_quotes(sources, one.span), desk.workspace);
      const bool known = location.is_null() || std::ranges::find(result, location) != result.end();
      if (!known) result.push_back(std::move(location));
    }
  }
  return result;
}

// ---- rename

namespace {

// Throws Refusal if it cannot be renamed.
Meant renamed_at(Desk desk, const Json& params) {
  const auto everywhere = meant_everywhere(desk, params);
  if (everywhere.empty()) throw Refusal("there is no name here");
  const Meant& meant = everywhere.front();
  const SourceMap& sources = sources_of(meant.asked);
  std::string why = query::why_not_renamed(*meant.symbol, meant.asked.file, sources);
  if (why.empty() && meant.asked.file != compiler::kProgramFile)
    why = "names of robot.json and of modules are changed by hand: other programs may use them";
  for (const Meant& other : everywhere)
    if (why.empty() && other.asked.file != compiler::kProgramFile)
      why = fmt::format("{} uses this file as a module", sources_of(other.asked).file(0).name());
  if (!why.empty()) throw Refusal(why);
  return meant;
}

}  // namespace

Json prepare_rename(Desk desk, const Json& params) {
  const Meant meant = renamed_at(desk, params);
  const SourceMap& sources = sources_of(meant.asked);
  return {{"range", range_json(sources, meant.name->span, desk.workspace.encoding())},
          {"placeholder", sources.text(meant.name->span)}};
}

Json rename(Desk desk, const Json& params) {
  const std::string name = params.at("newName").get<std::string>();
  const Meant meant = renamed_at(desk, params);
  const query::Symbols& symbols = meant.asked.checked->symbols();
  const std::string why =
      query::why_not_called(name, *meant.symbol, meant.asked.checked->project(), symbols);
  if (!why.empty()) throw Refusal(why);
  const SourceMap& sources = sources_of(meant.asked);
  Json changes = Json::object();
  for (const query::Occurrence& one : symbols.of(meant.name->symbol)) {
    const Json location = location_json(sources, without_quotes(sources, one.span), desk.workspace);
    if (location.is_null()) continue;
    changes[location["uri"].get<std::string>()].push_back(
        {{"range", location["range"]}, {"newText", name}});
  }
  return {{"changes", std::move(changes)}};
}

}  // namespace robosync::tool::lsp
