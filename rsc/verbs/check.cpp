// rsc check FILE… [--timing] [--anyway] [--config FILE] [--format human|json]
#include <cstddef>
#include <cstdint>
#include <iostream>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "analysis/report.hpp"
#include "compiler/diagnostics/render.hpp"
#include "rsc/algorithm_modules.hpp"
#include "rsc/board.hpp"
#include "rsc/console.hpp"
#include "rsc/failure.hpp"
#include "rsc/program.hpp"
#include "rsc/timing.hpp"
#include "rsc/verb.hpp"
#include "rsc/verb_options.hpp"

namespace robosync::tool {
namespace {

struct CheckOptions {
  std::vector<std::string> files;
  CompileOptions how;
  bool timing = false;
  bool anyway = false;
  Format format = Format::human;
};

// Several files make one report.
void append(nlohmann::ordered_json& all, const nlohmann::ordered_json& one) {
  if (all.is_null()) {
    all = one;
    return;
  }
  for (const auto& diagnostic : one.at("diagnostics"))
    all["diagnostics"].push_back(diagnostic);
  for (const char* const count : {"errors", "warnings"})
    all[count] = all.at(count).get<std::size_t>() + one.at(count).get<std::size_t>();
}

// What a program costs, also one that is too much for its board.
void report_timing(const CheckOptions& options, const std::string& file, compiler::Result& compiled,
                   nlohmann::ordered_json& report) {
  const Program program(std::move(compiled.image), file, memory_of(compiled.board));
  const policy::BoardCosts& costs = costs_of(compiled.board);
  const Timing timing = timing_of(program.image(), program.board());
  const analysis::ResponseReport responses =
      analysis::response_report(program.image(), costs, module_cost, cap_of(program.image()));
  if (options.format == Format::json) {
    auto object = timing_json(timing, file);
    object["responses"] = response_json(responses);
    report["timing"].push_back(std::move(object));
  } else {
    std::cout << '\n'
              << timing_text(timing, file) << '\n'
              << response_text(responses) << std::flush;
  }
}

void check(const CheckOptions& options) {
  nlohmann::ordered_json report;
  std::size_t errors = 0;
  for (const std::string& file : options.files) {
    compiler::Result result = compile_file(file, options.how);
    errors += result.diagnostics.errors();
    if (options.format == Format::json) {
      append(report, nlohmann::ordered_json::parse(
                         compiler::render_json(result.diagnostics, result.sources)));
    } else {
      std::cerr << compiler::render_human(result.diagnostics, result.sources, color_on_stderr());
      std::cout << fmt::format("{}: {}", file, summary(result.diagnostics)) << std::endl;
    }
    if (options.timing && !result.image.empty()) report_timing(options, file, result, report);
  }
  if (options.format == Format::json) std::cout << report.dump() << '\n';
  if (errors > 0) throw Failure(Exit::program, "");
}

}  // namespace

void add_check(Options& options) {
  auto asked = std::make_shared<CheckOptions>();
  options.arguments("FILE", asked->files, "programs (.rsl)", Options::Need::required);
  options.flag("--timing", asked->timing,
               "show what a step costs, rule by rule, and the memory it takes");
  options.flag("--anyway", asked->anyway, "also when it is too much for the board of robot.json");
  add_compile_options(options, asked->how);
  add_format_option(options, asked->format);
  options.runs([asked] {
    asked->how.judged = asked->anyway ? Judged::not_at_all : Judged::by_time;
    check(*asked);
  });
}

}  // namespace robosync::tool
