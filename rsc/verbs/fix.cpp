// rsc fix FILE… [--likely] [--config FILE]
#include <algorithm>
#include <iostream>
#include <map>
#include <memory>
#include <set>
#include <span>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "compiler/diagnostics/render.hpp"
#include "rsc/console.hpp"
#include "rsc/failure.hpp"
#include "rsc/output.hpp"
#include "rsc/program.hpp"
#include "rsc/verb.hpp"
#include "rsc/verb_options.hpp"

namespace robosync::tool {
namespace {

using compiler::Applicability, compiler::Fix;

struct FixOptions {
  std::vector<std::string> files;
  CompileOptions how;
  bool likely = false;
  bool quiet = false;
};

// The files with the fixes so far; nothing is written before the end.
class MendedTexts : public Texts {
public:
  MendedTexts() = default;
  MendedTexts(const MendedTexts& other)
      // NOLINTNEXTLINE(readability-redundant-member-init): without it GCC warns
      : Texts(), mended_(other.mended_) {}
  [[nodiscard]] std::string read(const std::filesystem::path& path) const override {
    const auto found = mended_.find(path.string());
    return found != mended_.end() ? found->second : Texts::read(path);
  }
  void set(const std::string& path, std::string text) { mended_[path] = std::move(text); }
  void write() const {
    for (const auto& [path, text] : mended_)
      write_edited(path, std::as_bytes(std::span(text)));
  }

private:
  std::map<std::string, std::string> mended_;
};

class Mender {
public:
  Mender(const std::string& file, const FixOptions& options) : file_(file), options_(options) {}

  void mend() {
    constexpr int kRounds = 10;  // a fix may expose another error
    compiler::Result result = compile_file(file_, options_.how, texts_);
    for (int round = 0; round < kRounds && apply(chosen(result), result); ++round)
      result = compile_file(file_, options_.how, texts_);
    texts_.write();
    show_diagnostics(result, options_.quiet);
    if (!options_.quiet)
      std::cout << fmt::format("{}: {} fixed{}; {}\n", file_, mended_, more(result),
                               summary(result.diagnostics));
    if (result.diagnostics.errors() > 0) throw Failure(Exit::program, "");
  }

private:
  // Sorted from last to first.
  std::vector<Fix> chosen(const compiler::Result& result) {
    std::vector<Fix> fixes;
    for (const compiler::Diagnostic& diagnostic : result.diagnostics.all())
      for (const Fix& fix : diagnostic.fixes)
        if (is_wanted(diagnostic, fix, result)) fixes.push_back(fix);
    const auto place = [](const Fix& fix) { return std::pair(fix.span.file, fix.span.begin); };
    std::ranges::sort(fixes, std::ranges::greater{}, place);
    return fixes;
  }

  bool is_wanted(const compiler::Diagnostic& diagnostic, const Fix& fix,
                 const compiler::Result& result) {
    const compiler::SourceMap& sources = result.sources;
    const compiler::SourceFile& file = sources.file(fix.span.file);
    if (file.name().starts_with('<')) return false;  // a library module
    if (fix.applicability == Applicability::certain)
      return diagnostic.level == compiler::Level::error;
    if (!options_.likely || !is_likely(fix, result)) return false;
    const std::string question = fmt::format("{}:{}: {}\n  `{}` -> `{}`? [y/N] ", file.name(),
                                             file.position(fix.span.begin).line, diagnostic.message,
                                             sources.text(fix.span), fix.replacement);
    return asked_.insert(question).second && says_yes(question);
  }

  // Likely, and no new error stands in its line afterwards.
  bool is_likely(const Fix& fix, const compiler::Result& result) const {
    if (fix.applicability != Applicability::likely) return false;
    MendedTexts tried = texts_;
    const compiler::SourceFile& file = result.sources.file(fix.span.file);
    std::string text(file.text());
    const std::uint32_t line = file.position(fix.span.begin).line;
    text.replace(fix.span.begin, end_of(fix, text) - fix.span.begin, fix.replacement);
    tried.set(std::string(file.name()), std::move(text));
    return std::ranges::includes(
        errors_in(line, fix.span.file, result),
        errors_in(line, fix.span.file, compile_file(file_, options_.how, tried)));
  }

  static std::set<std::string> errors_in(std::uint32_t line, compiler::FileId file,
                                         const compiler::Result& result) {
    std::set<std::string> errors;
    for (const compiler::Diagnostic& one : result.diagnostics.all())
      for (const compiler::Label& label : one.labels)
        if (one.level == compiler::Level::error && label.primary && label.span.file == file &&
            result.sources.file(file).position(label.span.begin).line == line)
          errors.insert(one.message);
    return errors;
  }

  // How many fixes --likely would ask about.
  std::string more(const compiler::Result& result) const {
    if (options_.likely) return "";
    const auto likely = [&](const compiler::Diagnostic& one) {
      return std::ranges::any_of(one.fixes, [&](const Fix& fix) { return is_likely(fix, result); });
    };
    const auto count = std::ranges::count_if(result.diagnostics.all(), likely);
    return count == 0 ? "" : fmt::format(", {} more with --likely", count);
  }

  static bool says_yes(const std::string& question) {
    std::cout << question << std::flush;
    std::string answer;
    std::getline(std::cin, answer);
    return answer == "y" || answer == "Y" || answer == "yes";
  }

  // False if there was nothing to do.
  bool apply(const std::vector<Fix>& fixes, const compiler::Result& result) {
    std::map<compiler::FileId, std::string> changed;
    std::map<compiler::FileId, std::uint32_t> free;  // start of the previous change
    for (const Fix& fix : fixes) {
      const compiler::SourceFile& file = result.sources.file(fix.span.file);
      const auto [text, first] = changed.try_emplace(fix.span.file, file.text());
      if (!first && fix.span.end > free[fix.span.file]) continue;
      text->second.replace(fix.span.begin, end_of(fix, text->second) - fix.span.begin,
                           fix.replacement);
      free[fix.span.file] = fix.span.begin;
      ++mended_;
    }
    for (auto& [id, text] : changed)
      texts_.set(result.sources.file(id).name(), std::move(text));
    return !changed.empty();
  }

  // Removing a word between two blanks also removes one blank.
  static std::uint32_t end_of(const Fix& fix, const std::string& text) {
    const auto is_blank = [&](std::size_t at) { return at < text.size() && text[at] == ' '; };
    const bool alone = fix.span.begin == 0 || is_blank(fix.span.begin - 1);
    return fix.span.end + (fix.replacement.empty() && alone && is_blank(fix.span.end) ? 1 : 0);
  }

  const std::string& file_;
  const FixOptions& options_;
  MendedTexts texts_;
  std::set<std::string> asked_;  // each is asked once
  std::size_t mended_ = 0;
};

void fix(const FixOptions& options) {
  const Exit exit =
      for_each_file(options.files, [&](const std::string& file) { Mender(file, options).mend(); });
  if (exit != Exit::fine) throw Failure(exit, "");
}

}  // namespace

void add_fix(Options& options) {
  auto asked = std::make_shared<FixOptions>();
  options.arguments("FILE", asked->files,
                    "programs (.rsl); they and their robot.json are rewritten",
                    Options::Need::required);
  options.flag("--likely", asked->likely, "also ask about fixes that are likely");
  add_compile_options(options, asked->how);
  add_quiet_option(options, asked->quiet, "say nothing if no error is left");
  options.runs([asked] { fix(*asked); });
}

}  // namespace robosync::tool
