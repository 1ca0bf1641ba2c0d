// rsc check FILE… [--config FILE] [--format human|json]
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "compiler/diagnostics/render.hpp"
#include "rsc/console.hpp"
#include "rsc/failure.hpp"
#include "rsc/program.hpp"
#include "rsc/verb.hpp"

namespace robosync::tool {
namespace {

struct Options {
  std::vector<std::string> files;
  CompileOptions how;
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

void check(const Options& options) {
  nlohmann::ordered_json report;
  std::size_t errors = 0;
  for (const std::string& file : options.files) {
    const compiler::Result result = compile_file(file, options.how);
    errors += result.diagnostics.errors();
    if (options.format == Format::json) {
      append(report, nlohmann::ordered_json::parse(
                         compiler::render_json(result.diagnostics, result.sources)));
      continue;
    }
    std::cerr << compiler::render_human(result.diagnostics, result.sources, color_on_stderr());
    std::cout << fmt::format("{}: {}", file, summary(result.diagnostics)) << std::endl;
  }
  if (options.format == Format::json) std::cout << report.dump() << '\n';
  if (errors > 0) throw Failure(Exit::program, "");
}

}  // namespace

void add_check(CLI::App& app) {
  auto options = std::make_shared<Options>();
  app.add_option("FILE", options->files, "programs (.rsl)")->required()->option_text("...");
  add_compile_options(app, options->how);
  add_format_option(app, options->format);
  app.callback([options] { check(*options); });
}

}  // namespace robosync::tool
