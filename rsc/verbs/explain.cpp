// rsc explain CODE|FILE [--config FILE] [--format human|json]
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "compiler/config/robot_reader.hpp"
#include "compiler/diagnostics/nearest.hpp"
#include "compiler/diagnostics/render.hpp"
#include "compiler/explain/codes.hpp"
#include "compiler/explain/program_text.hpp"
#include "compiler/reading.hpp"
#include "compiler/syntax/parser.hpp"
#include "rsc/algorithm_modules.hpp"
#include "rsc/console.hpp"
#include "rsc/failure.hpp"
#include "rsc/files.hpp"
#include "rsc/json.hpp"
#include "rsc/program.hpp"
#include "rsc/verb.hpp"
#include "rsc/verb_options.hpp"

namespace robosync::tool {
namespace {

namespace explain = compiler::explain;

struct ExplainOptions {
  std::string what, config;
  Format format = Format::human;
};

// E0301, w0203: a letter and four digits. A file name would have a dot or a folder.
bool looks_like_code(const std::string& what) {
  constexpr std::size_t kLength = 5;
  return what.size() == kLength && std::string_view("EWNewn").find(what[0]) != std::string::npos &&
         what.find_first_not_of("0123456789", 1) == std::string::npos;
}

void explain_code(const ExplainOptions& options) {
  const std::optional<compiler::Code> code = explain::find_code(options.what);
  if (!code) {
    std::vector<std::string> known;
    for (const explain::CodeText& text : explain::code_texts())
      known.emplace_back(compiler::code_name(text.code));
    const auto near = compiler::nearest(options.what, known);
    throw Failure(Exit::usage,
                  fmt::format("there is no diagnostic {}{}", options.what,
                              near ? fmt::format("; did you mean `{}`?", *near) : std::string()));
  }
  if (options.format == Format::human) {
    std::cout << explain::code_text(*code);
    return;
  }
  Json report{{"code", compiler::code_name(*code)},
              {"level", compiler::level_name(compiler::default_level(*code))},
              {"title", compiler::code_title(*code)}};
  for (const explain::CodeText& text : explain::code_texts()) {
    if (text.code != *code) continue;
    report["meaning"] = text.meaning;
    report["wrong"] = text.wrong;
    report["mended"] = text.mended;
  }
  std::cout << json_text(report) << '\n';
}

// A program without a configuration: its syntax is checked, not what its names mean.
compiler::Result read_alone(const std::string& file) {
  compiler::Result result;
  compiler::Reading reading;
  reading.tree = compiler::parse(result.sources, result.sources.add(file, read_text(file)),
                                 result.diagnostics);
  const Texts texts;
  reading.modules = compiler::load_modules(
      reading.tree, result.sources,
      [&](const std::string& user, const std::string& name) {
        return read_module(texts, user, name);
      },
      result.diagnostics);
  result.diagnostics.finish();
  result.reading = std::make_shared<compiler::Reading>(std::move(reading));
  return result;
}

// Empty if the program has none. A configuration named by --config must exist.
std::string configuration_of(const ExplainOptions& options) {
  if (!options.config.empty()) return options.config;
  try {
    return find_configuration(options.what, "").string();
  } catch (const Failure&) {
    return "";
  }
}

void explain_file(const ExplainOptions& options) {
  CompileOptions how;
  how.config = configuration_of(options);
  how.judged = Judged::not_at_all;
  const compiler::Result result =
      how.config.empty() ? read_alone(options.what) : compile_file(options.what, how);
  std::cerr << compiler::render_human(result.diagnostics, result.sources, color_on_stderr());
  if (result.diagnostics.errors() > 0) {
    if (options.format == Format::json)
      std::cout << compiler::render_json(result.diagnostics, result.sources);
    throw Failure(Exit::program, fmt::format("{}: {}", options.what, summary(result.diagnostics)));
  }
  const compiler::Reading& reading = *result.reading;
  const std::string text = explain::program_text(reading.trees(), result.sources,
                                                 reading.robot ? &*reading.robot : nullptr);
  if (options.format == Format::json) {
    std::cout << json_text({{"file", options.what}, {"text", text}}) << '\n';
  } else {
    std::cout << text;
  }
}

}  // namespace

void add_explain(Options& options) {
  auto asked = std::make_shared<ExplainOptions>();
  options.argument("FILE|CODE", asked->what, "program (.rsl), or a diagnostic such as E0301",
                   Options::Need::required);
  add_config_option(options, asked->config);
  add_format_option(options, asked->format);
  options.runs(
      [asked] { looks_like_code(asked->what) ? explain_code(*asked) : explain_file(*asked); });
}

}  // namespace robosync::tool
