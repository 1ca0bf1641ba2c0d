// textDocument/codeAction: the fixes that diagnostics carry.
#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "compiler/modules.hpp"
#include "compiler/reading.hpp"
#include "rsc/lsp/answers.hpp"
#include "rsc/lsp/uris.hpp"

namespace robosync::tool::lsp {

using compiler::Diagnostic, compiler::Fix, compiler::SourceFile, compiler::SourceMap,
    compiler::Span;

namespace {

std::string title_of(const Fix& fix, const SourceMap& sources) {
  const std::string_view old = sources.text(fix.span);
  const auto shown = [](std::string_view text) {
    text = text.substr(std::min(text.find_first_not_of(" \t\r\n"), text.size()));
    text = text.substr(0, text.find_last_not_of(" \t\r\n") + 1);
    return fmt::format("`{}`", text);
  };
  const char* const gap =
      fix.applicability == compiler::Applicability::placeholder ? ", to be filled in" : "";
  if (old.empty()) return fmt::format("Insert {}{}", shown(fix.replacement), gap);
  if (fix.replacement.empty()) return fmt::format("Remove {}", shown(old));
  return fmt::format("Replace {} with {}{}", shown(old), shown(fix.replacement), gap);
}

class ActionFinder {
public:
  ActionFinder(Desk desk, const Json& params)
      : desk_(desk), uri_(address_in(params)), path_(path_of(uri_)) {
    const Json& range = params.at("range");
    begin_ = place_in(range.at("start"));
    end_ = place_in(range.at("end"));
    if (const auto only = params.at("context").find("only"); only != params.at("context").end())
      for (const Json& kind : *only)
        only_.push_back(kind.get<std::string>());
  }

  Json run() {
    if (path_)
      for (const Checked* const checked : desk_.workspace.users_of(*path_))
        look(*checked);
    if (!all_.empty() && wants("source.fixAll"))
      actions_.push_back({{"title", "Apply all certain fixes"},
                          {"kind", "source.fixAll"},
                          {"edit", {{"changes", all_}}}});
    return std::move(actions_);
  }

private:
  [[nodiscard]] bool wants(std::string_view kind) const {
    return only_.empty() || std::ranges::any_of(only_, [&](const std::string& asked) {
             return kind == asked || kind.starts_with(asked + ".");
           });
  }
  [[nodiscard]] bool is_touched(const SourceMap& sources, Span span) const {
    const SourceFile& source = sources.file(span.file);
    const Encoding encoding = desk_.workspace.encoding();
    return source.name() == path_->string() && span.begin <= offset_of(source, end_, encoding) &&
           offset_of(source, begin_, encoding) <= span.end;
  }
  [[nodiscard]] bool is_touched(const SourceMap& sources, const Diagnostic& diagnostic,
                                const Fix& fix) const {
    const bool one_of_many = fix.applicability == compiler::Applicability::certain &&
                             diagnostic.fixes.size() > 1;  // each at its own place
    return is_touched(sources, fix.span) ||
           (!one_of_many &&
            std::ranges::any_of(diagnostic.labels, [&](const compiler::Label& label) {
              return label.primary && is_touched(sources, label.span);
            }));
  }

  void look(const Checked& checked) {
    const SourceMap& sources = checked.result().sources;
    for (const Diagnostic& diagnostic : checked.result().diagnostics.all()) {
      const auto found = finding_of(diagnostic, checked, desk_.workspace, desk_.client);
      if (found && found->uri == uri_) offer_module(checked, diagnostic, *found);
      for (const Fix& fix : diagnostic.fixes) {
        const Json location = location_json(sources, fix.span, desk_.workspace);
        if (location.is_null() || !found) continue;
        const Json edit = {{"range", location["range"]}, {"newText", fix.replacement}};
        const bool certain = fix.applicability == compiler::Applicability::certain;
        const std::string where = location["uri"].get<std::string>();
        if (certain && where == uri_) add_to_all(fix.span, where, edit);
        if (!is_touched(sources, diagnostic, fix) || !wants("quickfix")) continue;
        offer({{"title", title_of(fix, sources)},
               {"kind", "quickfix"},
               {"isPreferred", certain},
               {"diagnostics", Json::array({found->diagnostic})},
               {"edit", {{"changes", {{where, Json::array({edit})}}}}}});
      }
    }
  }
  // Two programs may report the same error in a shared robot.json.
  void offer(Json action) {
    if (std::ranges::find(actions_, action) == actions_.end())
      actions_.push_back(std::move(action));
  }
  // An unknown name may be in a module that the program does not USE.
  void offer_module(const Checked& checked, const Diagnostic& diagnostic, const Finding& found) {
    const std::string_view module =
        diagnostic.unknown.empty() ? std::string_view() : compiler::module_with(diagnostic.unknown);
    const auto& items = checked.result().reading->tree.items;
    if (module.empty() || items.empty() || !wants("quickfix")) return;
    const SourceMap& sources = checked.result().sources;
    const std::uint32_t begin = items.front().span.begin;
    const Json edit = {{"range", range_json(sources, {compiler::kProgramFile, begin, begin},
                                            desk_.workspace.encoding())},
                       {"newText", fmt::format("USE {}\n", module)}};
    const bool is_program = sources.file(compiler::kProgramFile).name() == path_->string();
    if (!is_program || !is_shown_here(found)) return;
    actions_.push_back({{"title", fmt::format("Insert `USE {}`", module)},
                        {"kind", "quickfix"},
                        {"isPreferred", false},
                        {"diagnostics", Json::array({found.diagnostic})},
                        {"edit", {{"changes", {{uri_, Json::array({edit})}}}}}});
  }
  [[nodiscard]] bool is_shown_here(const Finding& found) const {
    const Json& range = found.diagnostic.at("range");
    const Place first = place_in(range.at("start")), last = place_in(range.at("end"));
    const auto before = [](Place a, Place b) {
      return a.line < b.line || (a.line == b.line && a.character <= b.character);
    };
    return before(first, end_) && before(begin_, last);
  }
  // Only fixes that do not overlap.
  void add_to_all(Span span, const std::string& uri, const Json& edit) {
    const bool apart = std::ranges::none_of(
        taken_, [&](Span other) { return span.begin <= other.end && other.begin <= span.end; });
    if (!apart) return;
    taken_.push_back(span);
    all_[uri].push_back(edit);
  }

  Desk desk_;
  std::string uri_;
  std::optional<std::filesystem::path> path_;
  Place begin_, end_;
  std::vector<std::string> only_;
  std::vector<Span> taken_;
  Json all_ = Json::object();
  Json actions_ = Json::array();
};

}  // namespace

Json code_actions(Desk desk, const Json& params) {
  return ActionFinder(desk, params).run();
}

}  // namespace robosync::tool::lsp
