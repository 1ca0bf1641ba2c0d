#include "compiler/modules.hpp"

#include <algorithm>
#include <filesystem>
#include <set>

#include "compiler/config/names.hpp"
#include "compiler/diagnostics/nearest.hpp"
#include "compiler/syntax/keywords.hpp"
#include "compiler/syntax/lexer_state.hpp"
#include "compiler/syntax/parser.hpp"

namespace robosync::compiler {
namespace {

constexpr std::size_t kMaxModules = 64;

// A file of another kind does not begin with a word of RSL, and each of its lines would be an error.
bool is_something_else(std::string_view text, const Diagnostics& said) {
  constexpr std::size_t kManyErrors = 10;
  if (said.errors() < kManyErrors) return false;
  std::size_t at = text.find_first_not_of(" \t\r\n");
  while (at < text.size() && text[at] == '#')
    at = text.find_first_not_of(" \t\r\n", text.find('\n', at));
  text.remove_prefix(std::min(at, text.size()));
  return !is_keyword(text.substr(0, word_length(text)));
}

class Loader {
public:
  Loader(SourceMap& sources, const ModuleReader& read, Diagnostics& diagnostics,
         const Vocabulary* robot)
      : sources_(sources), read_(read), diagnostics_(diagnostics), robot_(robot) {}

  // The program itself counts as loaded: in a cycle, a module may USE it.
  std::vector<Module> load(const ast::Tree& program) {
    loaded_.insert(std::filesystem::path(sources_.file(0).name()).lexically_normal().string());
    add_uses(program, 0);
    for (std::size_t i = 0; i < modules_.size(); ++i)  // grows during the loop
      add_uses(*modules_[i].tree, modules_[i].file);
    return std::move(modules_);
  }

private:
  void add_uses(const ast::Tree& tree, FileId user) {
    for (const ast::Item& item : tree.items)
      if (const auto* use = std::get_if<ast::Use>(&item.node)) add(*use, user);
  }

  void add(const ast::Use& use, FileId user) {
    if (use.module.text.empty()) return;
    auto input = use.is_string ? find_file(use, user) : find_built_in(use);
    if (!input || !loaded_.insert(input->name).second) return;
    if (modules_.size() == kMaxModules) {
      diagnostics_
          .report(Code::E0407, "the program uses more than " + std::to_string(kMaxModules) +
                                   " modules, the most that rsc reads")
          .label(use.module.span, "this is one too many");
      return;
    }
    Module module;
    module.file = sources_.add(std::move(input->name), std::move(input->text));
    Diagnostics own;
    module.tree = std::make_unique<const ast::Tree>(parse(sources_, module.file, own, robot_));
    modules_.push_back(std::move(module));
    if (is_something_else(sources_.file(modules_.back().file).text(), own)) {
      const Diagnostic& first = own.all().front();
      diagnostics_
          .report(Code::E0410,
                  "the module \"" + std::string(use.module.text) + "\" does not look like RSL")
          .label(use.module.span)
          .label(first.labels.front().span, first.message, false);
      return;
    }
    for (const Diagnostic& one : own.all())
      diagnostics_.add(one);
  }

  std::optional<Input> find_built_in(const ast::Use& use) {
    std::vector<std::string> names;
    for (const ModuleText& module : module_texts()) {
      if (same_name(module.name, use.module.text))
        return Input{"<" + std::string(module.name) + ">", std::string(module.text)};
      names.emplace_back(module.name);
    }
    if (use.is_guess || is_keyword(use.module.text)) return std::nullopt;
    Diagnostic& d = diagnostics_.report(Code::E0501, "there is no module " + use.module.shown())
                        .label(use.module.span);
    if (!did_you_mean(d, use.module.span, use.module.text, names))
      d.helps("put your own file in quotes: `USE \"" + std::string(use.module.text) + ".rsl\"`");
    return std::nullopt;
  }

  std::optional<Input> find_file(const ast::Use& use, FileId user) {
    const std::string name(use.module.text);
    auto input = read_ ? read_(sources_.file(user).name(), name) : std::nullopt;
    if (input || use.is_guess) return input;
    Diagnostic& d = diagnostics_.report(Code::E0410, "the module \"" + name + "\" cannot be read")
                        .label(use.module.span);
    const auto is_meant = [&](const ModuleText& one) { return same_name(one.name, name); };
    if (std::ranges::any_of(module_texts(), is_meant))
      d.helps("a module of the library has no quotes: `USE " + name + "`")
          .fix(use.module.span, name, Applicability::likely);
    else
      d.helps("its path is relative to this file");
    return std::nullopt;
  }

  SourceMap& sources_;
  const ModuleReader& read_;
  Diagnostics& diagnostics_;
  const Vocabulary* robot_;
  std::vector<Module> modules_;
  std::set<std::string> loaded_;  // file names
};

}  // namespace

std::string_view module_with(std::string_view name, bool* is_motion) {
  for (const ModuleText& module : module_texts()) {
    for (std::string_view rest = module.text; !rest.empty();) {
      const std::string_view line = rest.substr(0, rest.find('\n'));
      rest.remove_prefix(std::min(rest.size(), line.size() + 1));
      for (const std::string_view gives : {"DEFINE ", "MOTION "}) {
        if (!line.starts_with(gives)) continue;
        const std::string_view given = line.substr(gives.size());
        if (!same_name(given.substr(0, given.find(' ')), name)) continue;
        if (is_motion != nullptr) *is_motion = gives == "MOTION ";
        return module.name;
      }
    }
  }
  return {};
}

std::vector<Module> load_modules(const ast::Tree& program, SourceMap& sources,
                                 const ModuleReader& read, Diagnostics& diagnostics,
                                 const Vocabulary* robot) {
  return Loader(sources, read, diagnostics, robot).load(program);
}

}  // namespace robosync::compiler
