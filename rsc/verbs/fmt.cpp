// rsc fmt FILE... [--check]
#include <iostream>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "compiler/diagnostics/render.hpp"
#include "rsc/console.hpp"
#include "rsc/failure.hpp"
#include "rsc/files.hpp"
#include "rsc/output.hpp"
#include "rsc/program.hpp"
#include "rsc/text_format.hpp"
#include "rsc/verb.hpp"
#include "rsc/verb_options.hpp"

namespace robosync::tool {
namespace {

struct FormatOptions {
  std::vector<std::string> files;
  bool check = false;
  bool quiet = false;
};

// The formatted text; nothing if it has errors, which are printed.
std::optional<std::string> formatted(const std::string& name, const std::string& text) {
  compiler::SourceMap sources;
  compiler::Diagnostics diagnostics;
  const compiler::FileId file = sources.add(name, text);
  std::optional<std::string> result = tool::formatted(sources, file, diagnostics);
  diagnostics.finish();
  if (diagnostics.errors() > 0)
    std::cerr << compiler::render_human(diagnostics, sources, color_on_stderr())
              << fmt::format("{}: {}; it is unchanged\n", name, summary(diagnostics));
  else if (!result)
    std::cerr << fmt::format("{}: cannot be formatted without changing it; it is unchanged\n",
                             name);
  return result;
}

// Stdin is written to stdout, for editors, unless it is only checked.
bool format_file(const std::string& file, const FormatOptions& options) {
  const bool is_stdin = file == "-";
  const std::string name = is_stdin ? "<stdin>" : file;
  const std::string text = read_text(is_stdin ? "/dev/stdin" : file);
  refuse_image(name, text);
  const std::optional<std::string> result = formatted(name, text);
  if (is_stdin && !options.check) {
    std::cout << result.value_or(text);
    return result.has_value();
  }
  if (!result) return false;
  if (*result == text) return true;
  if (!options.quiet) std::cout << name << '\n';
  if (!options.check) write_edited(name, std::as_bytes(std::span(*result)));
  return !options.check;
}

void format(const FormatOptions& options) {
  const Exit exit = for_each_file(options.files, [&](const std::string& file) {
    if (!format_file(file, options)) throw Failure(Exit::program, "");
  });
  if (exit != Exit::fine) throw Failure(exit, "");
}

}  // namespace

void add_fmt(Options& options) {
  auto asked = std::make_shared<FormatOptions>();
  options.arguments("FILE", asked->files,
                    "programs (.rsl) and robot.json, rewritten if they change; -: stdin to stdout",
                    Options::Need::required);
  options.flag("--check", asked->check, "change nothing; exit 1 when a file would change");
  add_quiet_option(options, asked->quiet, "do not name the files that change");
  options.runs([asked] { format(*asked); });
}

}  // namespace robosync::tool
