#include "rsc/lsp/workspace.hpp"

#include <algorithm>
#include <string_view>
#include <utility>

#include "compiler/project.hpp"
#include "compiler/reading.hpp"
#include "rsc/algorithm_modules.hpp"
#include "rsc/failure.hpp"
#include "rsc/lsp/library.hpp"
#include "rsc/lsp/uris.hpp"
#include "rsc/program.hpp"

namespace robosync::tool::lsp {
namespace fs = std::filesystem;
namespace {

using compiler::FileId, compiler::SourceFile;

constexpr std::string_view kProgram = ".rsl";

bool is_program(const fs::path& path) {
  return path.extension() == kProgram;
}

std::optional<fs::path> configuration_of(const fs::path& program, const Texts& texts) {
  try {
    return find_configuration(program, {}, texts);
  } catch (const Failure&) {
    return std::nullopt;
  }
}

// Checks the syntax of a program that cannot be read, or whose configuration cannot be read.
compiler::Result without_robot(const std::string& program, const Texts& texts) {
  std::string text;
  try {
    text = texts.read(program);
  } catch (const Failure&) {
    text.clear();  // a missing file has no errors
  }
  compiler::Result result = compiler::compile({program, std::move(text)}, {"robot.json", ""});
  compiler::Diagnostics kept;
  for (const compiler::Diagnostic& diagnostic : result.diagnostics.all()) {
    const bool of_program =
        !diagnostic.labels.empty() && diagnostic.labels.front().span.file == compiler::kProgramFile;
    if (of_program) kept.add(diagnostic);
  }
  result.diagnostics = std::move(kept);
  return result;
}

// Checks a robot.json that no program uses yet.
compiler::Result alone(const std::string& configuration, const Texts& texts) {
  compiler::Result result = compiler::compile({"", ""}, {configuration, texts.read(configuration)},
                                              {.algorithms = algorithm_modules()});
  compiler::Diagnostics kept;
  for (const compiler::Diagnostic& diagnostic : result.diagnostics.all()) {
    const auto is_there = [](const compiler::Label& label) {
      return label.span.file == compiler::kConfigurationFile;
    };
    if (std::ranges::any_of(diagnostic.labels, is_there)) kept.add(diagnostic);
  }
  result.diagnostics = std::move(kept);
  return result;
}

Checked compile_program(const std::string& program, const Texts& texts) {
  try {
    if (!is_program(program)) return Checked(alone(program, texts));
    CompileOptions how;
    how.judged = Judged::by_time;
    return Checked(compile_file(program, how, texts));
  } catch (const Failure& failure) {
    return Checked(without_robot(program, texts), failure.what());
  }
}

}  // namespace

std::string name_of(const std::string& uri) {
  const auto path = path_of(uri);
  return path ? path->string() : uri;
}

// ---- one program

compiler::query::Project Checked::project() const {
  return compiler::project_of(result_);
}

const compiler::query::Symbols& Checked::symbols() const {
  if (!symbols_) symbols_.emplace(project());
  return *symbols_;
}

std::optional<FileId> Checked::file(const fs::path& path) const {
  for (std::size_t id = 0; id < result_.sources.size(); ++id)
    if (result_.sources.file(static_cast<FileId>(id)).name() == path.string())
      return static_cast<FileId>(id);
  return std::nullopt;
}

// ---- documents

void Workspace::open(const std::string& uri, std::int64_t version, std::string text) {
  const std::string name = name_of(uri);
  documents_.insert_or_assign(name, Document{uri, version, SourceFile(name, std::move(text))});
  forget();  // it may replace one on disk
}

bool Workspace::change(const std::string& uri, std::int64_t version,
                       const std::vector<Change>& changes) {
  const auto found = documents_.find(name_of(uri));
  if (found == documents_.end()) return false;
  Document& document = found->second;
  document.version = version;
  for (const Change& change : changes) {
    std::string text;
    if (!change.whole) {
      const std::string_view before = document.source.text();
      const std::uint32_t begin = offset_of(document.source, change.begin, encoding_);
      const std::uint32_t end = std::max(begin, offset_of(document.source, change.end, encoding_));
      text.reserve(before.size() - (end - begin) + change.text.size());
      text.append(before.substr(0, begin)).append(change.text).append(before.substr(end));
    } else {
      text = change.text;
    }
    document.source = SourceFile(found->first, std::move(text));
  }
  changed(found->first);
  return true;
}

bool Workspace::close(const std::string& uri) {
  forget();
  return documents_.erase(name_of(uri)) > 0;
}

void Workspace::changed(const std::string& name) {
  std::erase_if(checked_, [&](const auto& one) {
    return one.first == name || one.second->file(name).has_value();
  });
}

const Document* Workspace::find(const std::string& uri) const {
  const auto found = documents_.find(name_of(uri));
  return found == documents_.end() ? nullptr : &found->second;
}

const Document* Workspace::find(const fs::path& path) const {
  const auto found = documents_.find(path.string());
  return found == documents_.end() ? nullptr : &found->second;
}

// ---- programs

std::set<std::string> Workspace::users_of_configuration(const fs::path& path) const {
  std::set<std::string> users;
  for (const fs::path& program : files_in(path.parent_path(), kProgram))
    if (users.size() < kMostPrograms && configuration_of(program, *this) == path)
      users.insert(program.string());
  for (const auto& [name, document] : documents_)
    if (is_program(name) && configuration_of(name, *this) == path) users.insert(name);
  if (users.empty() && path.filename() == "robot.json") users.insert(path.string());
  return users;
}

std::set<std::string> Workspace::programs() const {
  std::set<std::string> result;
  for (const auto& [name, document] : documents_) {
    if (is_in_library_folder(name) || !path_of(document.uri)) continue;
    if (is_program(name)) result.insert(name);
    if (fs::path(name).extension() == ".json") result.merge(users_of_configuration(name));
  }
  return result;
}

const Checked& Workspace::checked(const std::string& program) {
  auto& known = checked_[program];
  if (known == nullptr) known = std::make_unique<const Checked>(compile_program(program, *this));
  return *known;
}

namespace {

class OtherTexts : public Texts {
public:
  OtherTexts(const Texts& texts, const std::map<std::string, std::string>& others)
      : texts_(texts), others_(others) {}
  [[nodiscard]] std::string read(const fs::path& path) const override {
    const auto other = others_.find(path.lexically_normal().string());
    return other != others_.end() ? other->second : texts_.read(path);
  }
  [[nodiscard]] bool has(const fs::path& path) const override { return texts_.has(path); }

private:
  const Texts& texts_;
  const std::map<std::string, std::string>& others_;
};

}  // namespace

Checked Workspace::checked_with(const Checked& program,
                                const std::map<std::string, std::string>& texts) const {
  const compiler::SourceMap& sources = program.result().sources;
  const std::string& name = sources.file(compiler::kProgramFile).name();
  const std::string& alone = sources.file(compiler::kConfigurationFile).name();
  return compile_program(name.empty() ? alone : name, OtherTexts(*this, texts));
}

std::vector<const Checked*> Workspace::checked_programs() {
  const std::set<std::string> all = programs();
  const auto uses = [this](const std::string& user, const std::string& module) {
    return user != module && checked(user).file(module).has_value();
  };
  std::vector<const Checked*> result;
  for (const std::string& one : all) {
    const bool is_module = std::ranges::any_of(
        all, [&](const std::string& other) { return uses(other, one) && !uses(one, other); });
    if (!is_module) result.push_back(&checked(one));
  }
  return result;
}

std::vector<const Checked*> Workspace::users_of(const fs::path& path) {
  std::vector<const Checked*> users;
  for (const std::string& program : programs()) {
    const Checked& one = checked(program);
    if (!one.file(path)) continue;
    users.insert(program == path.string() ? users.begin() : users.end(), &one);
  }
  return users;
}

// ---- Texts

std::string Workspace::read(const fs::path& path) const {
  const Document* const document = find(path.lexically_normal());
  return document != nullptr ? std::string(document->source.text()) : read_text(path);
}

bool Workspace::has(const fs::path& path) const {
  return find(path.lexically_normal()) != nullptr || Texts::has(path);
}

}  // namespace robosync::tool::lsp
