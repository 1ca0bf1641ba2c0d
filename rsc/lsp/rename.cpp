// Renaming: in all files of all programs that use the name, open or not, and only if every name means the same afterwards.
#include "compiler/query/rename.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include <fmt/format.h>

#include "rsc/lsp/meant.hpp"

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
  Span span;
  std::string text;
};
struct Changed {
  const SourceMap* sources = nullptr;
  std::map<std::uint32_t, Edit> edits{};  // by their beginning
};
using Changes = std::map<std::string, Changed>;  // by file

void add(Changes& changes, const SourceMap& sources, Span span, std::string text) {
  Changed& changed = changes[sources.file(span.file).name()];
  changed.sources = &sources;
  changed.edits.insert_or_assign(span.begin, Edit{span, std::move(text)});
}

// With the names in which it is a part: `touchLevel` for the sensor `touch`.
void add_changes(Changes& changes, const Meant& meant, const std::string& name) {
  const SourceMap& sources = sources_of(meant.asked);
  const query::Symbols& symbols = meant.asked.checked->symbols();
  const query::Project project = meant.asked.checked->project();
  for (const query::Occurrence& one : symbols.occurrences()) {
    const Span span = without_quotes(sources, one.span);
    const query::Symbol& other = symbols.all()[one.symbol];
    const auto joined = query::joined_name(sources.text(span), other, *meant.symbol, name, project);
    if (joined && span.file != kConfigurationFile)
      add(changes, sources, span, *joined);
    else if (one.symbol == meant.name->symbol)
      add(changes, sources, span, name);
  }
}

std::string changed_text(const Changed& changed) {
  const Span first = changed.edits.begin()->second.span;
  const SourceFile& source = changed.sources->file(first.file);
  std::string text;
  std::size_t at = 0;
  for (const auto& [begin, edit] : changed.edits) {
    text.append(source.text().substr(at, begin - at)).append(edit.text);
    at = edit.span.end;
  }
  return text.append(source.text().substr(at));
}

void refuse_other_meaning(Desk desk, const std::vector<Meant>& all, const Changes& changes) {
  std::map<std::string, std::string> texts;
  for (const auto& [file, changed] : changes)
    texts[file] = changed_text(changed);
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
  Changes changes;
  for (const Meant& meant : all) {
    const Checked& checked = *meant.asked.checked;
    const std::string why =
        query::why_not_called(name, *meant.symbol, checked.project(), checked.symbols());
    if (!why.empty()) throw Refusal(why);
    add_changes(changes, meant, name);
  }
  refuse_other_meaning(desk, all, changes);
  Json result = Json::object();
  for (const auto& [file, changed] : changes)
    for (const auto& [begin, edit] : changed.edits) {
      const Json location = location_json(*changed.sources, edit.span, desk.workspace);
      if (location.is_null()) continue;
      result[location["uri"].get<std::string>()].push_back(
          {{"range", location["range"]}, {"newText", edit.text}});
    }
  return {{"changes", std::move(result)}};
}

}  // namespace robosync::tool::lsp
