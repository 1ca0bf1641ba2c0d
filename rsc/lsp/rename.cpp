// Renaming: in all files of all programs that use the name, open or not, and only if every name means the same afterwards.
#include "compiler/query/rename.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include <fmt/format.h>

#include "compiler/source/sorting.hpp"
#include "rsc/lsp/meant.hpp"
#include "rsc/lsp/scenarios.hpp"

namespace robosync::tool::lsp {

namespace query = compiler::query;
using compiler::kConfigurationFile, compiler::kProgramFile, compiler::SourceFile,
    compiler::SourceMap, compiler::Span;

namespace {

std::string_view file_name(const SourceFile& file) {
  const std::string_view name = file.name();
  return name.substr(name.rfind('/') + 1);
}

// ---- may it be renamed?

void refuse_library(const Meant& meant) {
  for (const query::Occurrence& one : places_of(meant)) {
    const std::string& name = sources_of(meant.asked).file(one.span.file).name();
    if (name.starts_with('<'))
      throw Refusal(
          fmt::format("the module {} of the library uses `{}`", name, meant.symbol->name));
  }
}

// A module with the name that a program of another robot uses, too.
void refuse_shared_module(Desk desk, const Meant& meant, const std::vector<Meant>& all) {
  for (const query::Occurrence& one : places_of(meant)) {
    if (one.span.file <= kConfigurationFile) continue;
    const SourceFile& module = sources_of(meant.asked).file(one.span.file);
    for (const Checked* const user : desk.workspace.users_of(module.name())) {
      const bool known =
          std::ranges::any_of(all, [&](const Meant& other) { return other.asked.checked == user; });
      if (!known)
        throw Refusal(fmt::format("{} says `{}`, and is also a module of {}, where that is another",
                                  file_name(module), meant.symbol->name,
                                  user->result().sources.file(kProgramFile).name()));
    }
  }
}

void refuse_module_of_others(const Meant& meant) {
  if (meant.symbol->declared->file <= kConfigurationFile) return;
  throw Refusal(
      fmt::format("{} uses this file as a module", sources_of(meant.asked).file(0).name()));
}

// Of a name in robot.json, which all its programs may say.
void refuse_many_programs(Desk desk, const Meant& meant) {
  const auto in_robot = [](const query::Occurrence& one) {
    return one.span.file == kConfigurationFile;
  };
  const SourceFile& robot = sources_of(meant.asked).file(kConfigurationFile);
  if (!std::ranges::any_of(places_of(meant), in_robot) ||
      desk.workspace.users_of_configuration(robot.name()).size() < kMostPrograms)
    return;
  throw Refusal(fmt::format("so many programs use {} that not all of them are known: {} or more",
                            file_name(robot), kMostPrograms));
}

// The name in each program in which it is to be changed, at least one. Throws Refusal if it cannot be.
std::vector<Meant> renamed_at(Desk desk, const Json& params) {
  std::vector<Meant> all = meant_everywhere(desk, params);
  if (all.empty()) throw Refusal("there is no name here");
  const std::string why =
      query::why_not_renamed(*all.front().symbol, sources_of(all.front().asked));
  if (!why.empty()) throw Refusal(why);
  refuse_many_programs(desk, all.front());
  for (const Meant& meant : all) {
    refuse_module_of_others(meant);
    refuse_library(meant);
    refuse_shared_module(desk, meant, all);
  }
  return all;
}

// ---- the changes

struct Edit {
  const SourceMap* sources = nullptr;
  Span span;
  std::string text;

  [[nodiscard]] const SourceFile& file() const { return sources->file(span.file); }
};
using Edits = std::vector<Edit>;

bool comes_before(const Edit& a, const Edit& b) {
  return a.file().name() != b.file().name() ? a.file().name() < b.file().name()
                                            : a.span.begin < b.span.begin;
}

// Two programs have the same edits of what both use.
Edits in_order(Edits edits) {
  compiler::sort_stably(edits, comes_before);
  const auto same = [](const Edit& a, const Edit& b) { return !comes_before(a, b); };
  edits.erase(std::unique(edits.begin(), edits.end(), same), edits.end());
  return edits;
}

// With the names in which it is a part: `touchLevel` for the sensor `touch`.
void add_edits(Edits& edits, const Meant& meant, const std::string& name) {
  const SourceMap& sources = sources_of(meant.asked);
  const query::Symbols& symbols = meant.asked.checked->symbols();
  const query::Project project = meant.asked.checked->project();
  for (const query::Occurrence& one : symbols.occurrences()) {
    const Span span = without_quotes(sources, one.span);
    const query::Symbol& other = symbols.all()[one.symbol];
    const auto joined = query::joined_name(sources.text(span), other, *meant.symbol, name, project);
    if (joined && span.file != kConfigurationFile)
      edits.push_back({&sources, span, *joined});
    else if (one.symbol == meant.name->symbol)
      edits.push_back({&sources, span, name});
  }
}

// In the scenarios of the robot to which the sensor or the channel belongs.
void add_edits(Edits& edits, const Scenarios& scenarios, const Meant& meant,
               const std::string& name) {
  const query::Symbol& symbol = *meant.symbol;
  std::vector<Span> places;
  if (symbol.kind == query::SymbolKind::sensor) places = scenarios.sensor(symbol.name);
  if (symbol.kind == query::SymbolKind::channel) {
    const auto& sensors = meant.asked.checked->project().robot.sensors;
    places = scenarios.channel(sensors.at(symbol.owner).name.text, symbol.name);
  }
  for (const Span place : places)
    edits.push_back({&scenarios.sources(), place, name});
}

// The texts with the edits, by the names of their files.
std::map<std::string, std::string> edited_texts(const Edits& edits) {
  std::map<std::string, std::string> texts;
  // From the last to the first, so that the places of the others stay.
  for (auto edit = edits.rbegin(); edit != edits.rend(); ++edit) {
    const SourceFile& file = edit->file();
    const auto text = texts.try_emplace(file.name(), file.text()).first;
    text->second.replace(edit->span.begin, edit->span.end - edit->span.begin, edit->text);
  }
  return texts;
}

void refuse_other_meaning(Desk desk, const std::vector<Meant>& all, const Edits& edits) {
  const auto texts = edited_texts(edits);
  for (const Meant& meant : all) {
    const Checked after = desk.workspace.checked_with(*meant.asked.checked, texts);
    const std::string why = query::why_not_same(meant.asked.checked->symbols(),
                                                meant.asked.checked->result().diagnostics,
                                                after.symbols(), after.result().diagnostics);
    if (!why.empty()) throw Refusal(why);
  }
}

}  // namespace

Json prepare_rename(Desk desk, const Json& params) {
  const Meant meant = renamed_at(desk, params).front();
  const SourceMap& sources = sources_of(meant.asked);
  const Span span = without_quotes(sources, meant.name->span);
  return {{"range", range_json(sources, span, desk.workspace.encoding())},
          {"placeholder", sources.text(span)}};
}

Json rename(Desk desk, const Json& params) {
  const std::string name = params.at("newName").get<std::string>();
  desk.workspace.forget();  // files that are not open may have changed
  const std::vector<Meant> all = renamed_at(desk, params);
  Edits edits;
  for (const Meant& meant : all) {
    const Checked& checked = *meant.asked.checked;
    const std::string why =
        query::why_not_called(name, *meant.symbol, checked.project(), checked.symbols());
    if (!why.empty()) throw Refusal(why);
    add_edits(edits, meant, name);
  }
  const std::string& robot = sources_of(all.front().asked).file(kConfigurationFile).name();
  const Scenarios scenarios(desk.workspace, robot);
  add_edits(edits, scenarios, all.front(), name);
  edits = in_order(std::move(edits));
  refuse_other_meaning(desk, all, edits);
  Json result = Json::object();
  for (const Edit& edit : edits) {
    const Json location = location_json(*edit.sources, edit.span, desk.workspace);
    if (location.is_null()) continue;
    result[location["uri"].get<std::string>()].push_back(
        {{"range", location["range"]}, {"newText", edit.text}});
  }
  return {{"changes", std::move(result)}};
}

}  // namespace robosync::tool::lsp
