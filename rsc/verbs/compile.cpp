// rsc compile FILE [-o X.rsb] [--strip] [--anyway] [--config FILE] [-O0] [--format human|json]
#include <filesystem>
#include <iostream>
#include <memory>
#include <string>

#include <fmt/format.h>

#include "compiler/diagnostics/render.hpp"
#include "rsc/console.hpp"
#include "rsc/failure.hpp"
#include "rsc/json.hpp"
#include "rsc/output.hpp"
#include "rsc/program.hpp"
#include "rsc/verb.hpp"
#include "rsc/verb_options.hpp"

namespace robosync::tool {
namespace {

struct OutputOptions {
  std::string file, output;
  bool strip = false;
  bool anyway = false;
  bool quiet = false;
  CompileOptions how;
  Format format = Format::human;
};

std::string output_name(const OutputOptions& options) {
  if (!options.output.empty()) return options.output;
  auto name = std::filesystem::path(options.file).replace_extension(".rsb").string();
  if (name == options.file) {
    throw Failure(Exit::usage, name + ": this is an image already; name the output with -o");
  }
  return name;
}

void print_human(std::ostream& out, const std::string& output, const Program& program) {
  out << fmt::format("{}: {} bytes, a step costs up to {} instructions\n", output,
                     program.bytes().size(), program.image().header->step_cost);
  for (const SectionSize& size : section_sizes(program.image())) {
    out << fmt::format("  {:<14}{:>5} x {:>6} bytes\n", vm::describe(size.section), size.records,
                       size.bytes);
  }
}

void print_json(std::ostream& out, const std::string& output, const Program& program) {
  Json report;
  report["file"] = output;
  report["bytes"] = program.bytes().size();
  report["step_cost"] = program.image().header->step_cost;
  report["sections"] = Json::array();
  for (const SectionSize& size : section_sizes(program.image())) {
    report["sections"].push_back({{"section", vm::describe(size.section)},
                                  {"records", size.records},
                                  {"bytes", size.bytes}});
  }
  out << json_text(report) << '\n';
}

void compile(const OutputOptions& options) {
  const std::string output = output_name(options);
  compiler::Result result = compile_file(options.file, options.how);
  show_diagnostics(result, options.quiet);
  print_json_errors(result, options.how);
  if (result.diagnostics.errors() > 0) {
    throw Failure(Exit::program, fmt::format("{}: {}; nothing was written", options.file,
                                             summary(result.diagnostics)));
  }
  const Program program(std::move(result.image), options.file, memory_of(result.board));
  check_output({output}, names_of(result.sources));
  // If the image goes to stdout, the report must not.
  std::ostream& out = is_stdout(output) ? std::cerr : std::cout;
  write_output(output, program.bytes());
  if (options.quiet) return;
  options.format == Format::json ? print_json(out, output, program)
                                 : print_human(out, output, program);
}

}  // namespace

void add_compile(Options& options) {
  auto asked = std::make_shared<OutputOptions>();
  options.argument("FILE", asked->file, "program (.rsl)", Options::Need::required);
  options.option("-o,--output", "X.rsb", asked->output, "the image; else STEM.rsb");
  options.flag("--strip", asked->strip,
               "leave out the table of source lines; each rule keeps its line");
  options.flag("--anyway", asked->anyway, "even if it is too much for the board in robot.json");
  add_compile_options(options, asked->how);
  add_seed_option(options, asked->how.seed);
  add_format_option(options, asked->format);
  add_quiet_option(options, asked->quiet, "say nothing if there is no error");
  options.runs([asked] {
    refuse_pair(asked->quiet && asked->format == Format::json, "--quiet", "--format json");
    asked->how.json = asked->format == Format::json;
    asked->how.source_lines = !asked->strip;
    asked->how.judged = asked->anyway ? Judged::not_at_all : Judged::by_time;
    compile(*asked);
  });
}

}  // namespace robosync::tool
