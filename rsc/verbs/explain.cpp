// rsc explain CODE|FILE [--config FILE] [--format human|json]
#include <algorithm>
#include <iostream>
#include <iterator>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "compiler/diagnostics/nearest.hpp"
#include "compiler/diagnostics/render.hpp"
#include "compiler/explain/codes.hpp"
#include "compiler/explain/program_text.hpp"
#include "compiler/reading.hpp"
#include "compiler/source/ascii.hpp"
#include "rsc/console.hpp"
#include "rsc/failure.hpp"
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

// E0301, w0203, also E301 and 0301. A file name would have a dot or a folder.
bool looks_like_code(std::string_view what) {
  if (!what.empty() && std::string_view("EWNewn").find(what[0]) != std::string_view::npos)
    what.remove_prefix(1);
  return !what.empty() && what.find_first_not_of("0123456789") == std::string_view::npos;
}

// Any letter if there is none; zeros in front may be missing.
bool is_code(std::string_view name, std::string_view word) {
  const bool has_letter = !compiler::ascii::is_digit(word[0]);
  if (has_letter && !compiler::ascii::same(name.substr(0, 1), word.substr(0, 1))) return false;
  const std::string_view digits = word.substr(has_letter ? 1 : 0);
  const std::string_view number = name.substr(1);
  return number.ends_with(digits) && number.find_first_not_of('0') >= number.size() - digits.size();
}

compiler::Code find_code(const std::string& word) {
  std::vector<std::string> known, meant;
  for (const explain::CodeText& text : explain::code_texts())
    known.emplace_back(compiler::code_name(text.code));
  std::ranges::copy_if(known, std::back_inserter(meant),
                       [&](const std::string& name) { return is_code(name, word); });
  if (meant.size() == 1) return *explain::find_code(meant.front());
  if (const auto near = compiler::nearest(word, known); near && meant.empty())
    meant.push_back(*near);
  throw Failure(
      Exit::usage,
      fmt::format("there is no diagnostic {}; {}", word,
                  meant.empty() ? "a code is a letter and four digits, such as E0301"
                                : fmt::format("did you mean `{}`?", fmt::join(meant, "` or `"))));
}

void explain_code(const ExplainOptions& options) {
  const compiler::Code code = find_code(options.what);
  if (options.format == Format::human) {
    std::cout << explain::code_text(code);
    return;
  }
  Json report{{"code", compiler::code_name(code)},
              {"level", compiler::level_name(compiler::default_level(code))},
              {"title", compiler::code_title(code)}};
  for (const explain::CodeText& text : explain::code_texts()) {
    if (text.code != code) continue;
    report["meaning"] = text.meaning;
    report["wrong"] = text.wrong;
    report["mended"] = text.mended;
  }
  std::cout << json_text(report) << '\n';
}

void explain_file(const ExplainOptions& options) {
  CompileOptions how;
  how.config = options.config;
  how.judged = Judged::not_at_all;
  const compiler::Result result = compile_file(options.what, how);
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
