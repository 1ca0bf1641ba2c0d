// rsc check FILE… [--timing] [--anyway] [--config FILE] [--format human|json|sarif]
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <iostream>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "analysis/report.hpp"
#include "compiler/diagnostics/render.hpp"
#include "compiler/diagnostics/sarif.hpp"
#include "rsc/algorithm_modules.hpp"
#include "rsc/board.hpp"
#include "rsc/console.hpp"
#include "rsc/failure.hpp"
#include "rsc/json.hpp"
#include "rsc/program.hpp"
#include "rsc/timing.hpp"
#include "rsc/verb.hpp"
#include "rsc/verb_options.hpp"

namespace robosync::tool {
namespace {

enum class Report : std::uint8_t { human, json, sarif };

struct CheckOptions {
  std::vector<std::string> files;
  CompileOptions how;
  bool timing = false;
  bool anyway = false;
  bool quiet = false;
  Report format = Report::human;
};

// Several files give one report.
void append(Json& all, const Json& one) {
  for (const auto& diagnostic : one.at("diagnostics"))
    all["diagnostics"].push_back(diagnostic);
  for (const char* const count : {"errors", "warnings"})
    all[count] = all.at(count).get<std::size_t>() + one.at(count).get<std::size_t>();
}

// The cost of a program, even of one that is too much for its board.
void report_timing(const CheckOptions& options, const std::string& file, compiler::Result& compiled,
                   Json& report) {
  const Program program(std::move(compiled.image), file, memory_of(compiled.board));
  const policy::BoardCosts& costs = costs_of(compiled.board);
  const Timing timing = timing_of(program.image(), program.board());
  const analysis::ResponseReport responses =
      analysis::response_report(program.image(), costs, module_cost, cap_of(program.image()));
  if (options.format == Report::json) {
    auto object = timing_json(timing, file);
    object["responses"] = response_json(responses);
    report["timing"].push_back(std::move(object));
  } else {
    std::cout << '\n'
              << timing_text(timing, file) << '\n'
              << response_text(responses) << std::flush;
  }
}

// Also from standard input, with the robot.json of this folder.
class CheckedTexts : public Texts {
public:
  [[nodiscard]] std::string read(const std::filesystem::path& path) const override {
    return Texts::read(path == "-" ? "/dev/stdin" : path);
  }
};

class Checker {
public:
  explicit Checker(const CheckOptions& options) : options_(options) {}

  void check(const std::string& file) {
    compiler::Result result = compile_file(file, options_.how, CheckedTexts());
    switch (options_.format) {
      case Report::human:
        show_diagnostics(result, options_.quiet);
        if (options_.quiet) break;
        std::cout << fmt::format("{}: {}", result.sources.file(compiler::kProgramFile).name(),
                                 summary(result.diagnostics))
                  << std::endl;
        break;
      case Report::json:
        append(report_, read_json(compiler::render_json(result.diagnostics, result.sources)));
        break;
      case Report::sarif:
        log_.add(result.diagnostics, result.sources);
        break;
    }
    if (options_.timing && !result.image.empty()) report_timing(options_, file, result, report_);
    if (result.diagnostics.errors() > 0) throw Failure(Exit::program, "");
  }

  // A file that cannot be read must not look like one without errors.
  void note_failure(const std::string& file, const Failure& failure) {
    if (*failure.what() == '\0') return;
    report_["not_checked"].push_back({{"file", file}, {"why", failure.what()}});
    log_.add_unchecked(file, failure.what());
  }

  // After all files have been checked.
  void finish() const {
    if (options_.format == Report::json) std::cout << json_text(report_) << '\n';
    if (options_.format == Report::sarif) std::cout << log_.text();
  }

private:
  const CheckOptions& options_;
  Json report_ = {{"diagnostics", Json::array()}, {"errors", 0}, {"warnings", 0}};
  compiler::SarifLog log_{ROBOSYNC_VERSION};
};

void check(const CheckOptions& options) {
  Checker checker(options);
  const Exit exit = for_each_file(options.files, [&](const std::string& file) {
    try {
      checker.check(file);
    } catch (const Failure& failure) {
      checker.note_failure(file, failure);
      throw;
    }
  });
  checker.finish();
  if (exit != Exit::fine) throw Failure(exit, "");
}

}  // namespace

void add_check(Options& options) {
  auto asked = std::make_shared<CheckOptions>();
  options.arguments("FILE", asked->files,
                    "programs (.rsl); -: from stdin, with the robot.json of this folder",
                    Options::Need::required);
  options.flag(
      "--timing", asked->timing,
      "show what a step costs, rule by rule, and the memory it takes; not with --format sarif");
  options.flag("--anyway", asked->anyway, "even if it is too much for the board in robot.json");
  add_compile_options(options, asked->how);
  options.choice(
      "--format", {"human", "json", "sarif"},
      [asked](std::size_t index) { asked->format = static_cast<Report>(index); },
      "human, json or sarif (2.1.0)");
  add_quiet_option(options, asked->quiet, "say nothing if there is no error");
  options.runs([asked] {
    refuse_pair(asked->quiet && asked->timing, "--quiet", "--timing");
    refuse_pair(asked->quiet && asked->format != Report::human, "--quiet", "--format");
    refuse_pair(asked->timing && asked->format == Report::sarif, "--timing", "--format sarif");
    asked->how.judged = asked->anyway ? Judged::not_at_all : Judged::by_time;
    check(*asked);
  });
}

}  // namespace robosync::tool
