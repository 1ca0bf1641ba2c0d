// rsc trace convert T.jsonl --to perfetto|csv|vcd [-o FILE]
#include <array>
#include <iostream>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include <fmt/format.h>

#include "rsc/failure.hpp"
#include "rsc/output.hpp"
#include "rsc/trace/convert.hpp"
#include "rsc/verb.hpp"
#include "rsc/verb_options.hpp"

namespace robosync::tool {
namespace {

struct TraceFormat {
  const char* name;
  std::string (*convert)(const std::string& file);
};
constexpr std::array kFormats = {TraceFormat{"perfetto", perfetto_of}, TraceFormat{"csv", csv_of},
                                 TraceFormat{"vcd", vcd_of}};

struct TraceOptions {
  std::string what, file, output;
  const TraceFormat* to = nullptr;
};

void convert(const TraceOptions& options) {
  if (options.what != "convert")
    throw Failure(
        Exit::usage,
        fmt::format("`rsc trace {}` does not exist; write `rsc trace convert`", options.what));
  if (options.to == nullptr)
    throw Failure(Exit::usage, "name the format: --to perfetto, csv or vcd");
  if (!options.output.empty()) check_output({options.output}, {options.file});
  const std::string text = options.to->convert(options.file);
  if (options.output.empty())
    std::cout << text;
  else
    write_output(options.output, std::as_bytes(std::span(text)));
}

}  // namespace

void add_trace(Options& options) {
  auto asked = std::make_shared<TraceOptions>();
  options.argument("convert", asked->what, "what to do with it", Options::Need::required);
  options.argument("FILE", asked->file, "a trace from rsc run --trace or rsc monitor --format json",
                   Options::Need::required);
  std::vector<std::string> names;
  names.reserve(std::size(kFormats));
  for (const TraceFormat& format : kFormats)
    names.emplace_back(format.name);
  options.choice(
      "--to", names, [asked](std::size_t index) { asked->to = &kFormats.at(index); },
      "for ui.perfetto.dev, a spreadsheet, or GTKWave");
  options.option("-o,--output", "FILE", asked->output, "else to stdout");
  options.runs([asked] { convert(*asked); });
}

}  // namespace robosync::tool
