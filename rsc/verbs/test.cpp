// rsc test FILE… [--config FILE] [--format human|json]
#include <algorithm>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "compiler/diagnostics/render.hpp"
#include "compiler/diagnostics/snippet.hpp"
#include "rsc/console.hpp"
#include "rsc/failure.hpp"
#include "rsc/json.hpp"
#include "rsc/program.hpp"
#include "rsc/trace/expectations.hpp"
#include "rsc/trace/time_units.hpp"
#include "rsc/trace/trace_format.hpp"
#include "rsc/verb.hpp"
#include "rsc/verb_options.hpp"

namespace robosync::tool {
namespace {

constexpr std::uint64_t kBefore = 500'000;  // shown before a failure, in microseconds
constexpr std::size_t kTimelineEnds = 15;   // lines at each end of a long timeline

struct TestOptions {
  std::vector<std::string> files;
  CompileOptions how;
  Format format = Format::human;
  bool quiet = false;
};

struct Tally {
  std::size_t passed = 0, failed = 0;
  Json tests = Json::array();
  Json diagnostics = Json::array();  // of programs with errors
};

// Prints each test when it ends.
class Reporter {
public:
  Reporter(const TestOptions& options, const compiler::SourceMap& sources, Tally& tally)
      : options_(options), sources_(sources), tally_(tally) {}

  void report(const TestResult& result) {
    result.failed == nullptr ? ++tally_.passed : ++tally_.failed;
    options_.format == Format::json ? add_json(result) : print(result);
  }

private:
  std::size_t line(compiler::Span span) const {
    return sources_.file(span.file).position(span.begin).line;
  }
  const std::string& file(compiler::Span span) const { return sources_.file(span.file).name(); }
  std::string step(const TestResult& result) const {
    return std::string(sources_.text(result.failed->span));
  }

  static std::vector<link::Event> around(const TestResult& result) {
    const std::uint64_t from = result.failed->from * kMicroseconds;
    std::vector<link::Event> events;
    for (const link::Event& event : result.recording.events) {
      if (event.time_us + kBefore >= from &&
          event.time_us <= result.failed->until * kMicroseconds) {
        events.push_back(event);
      }
    }
    return events;
  }

  void print(const TestResult& result) const {
    const bool fine = result.failed == nullptr && result.recording.unseen.empty();
    if (options_.quiet && fine) return;
    std::cout << (result.failed == nullptr ? "ok      " : "FAILED  ") << result.test->title << '\n';
    if (result.failed != nullptr) print_failure(result);
    for (const auto* const reading : result.recording.unseen)
      print_step(reading->span, "warning: " + why_unseen(result, *reading));
    std::cout << std::flush;
  }

  static std::string why_unseen(const TestResult& result,
                                const compiler::test_plan::PlannedReading& reading) {
    const std::string& sensor = result.recording.plan->channels.at(reading.channel).sensor;
    const vm::Image& image = *result.recording.image;
    const auto found =
        std::ranges::find(image.sensors, std::string_view(sensor),
                          [&](const vm::Sensor& one) { return image.string(one.name); });
    return fmt::format(
        "the robot never sees this: {} is sampled every {} ms, and the value does not last "
        "until a sample",
        sensor, found == image.sensors.end() ? 0 : found->period_ms);
  }

  void print_failure(const TestResult& result) const {
    print_step(result.failed->span, result.reason);
    const std::vector<link::Event> events = around(result);
    const TraceNames names{result.recording.image, result.recording.threads,
                           result.recording.origin};
    std::cout << (events.empty() ? "    nothing happened\n" : "    what happened:\n");
    for (std::size_t i = 0; i < events.size(); ++i) {
      const bool left_out = i >= kTimelineEnds && i + kTimelineEnds < events.size();
      if (!left_out) {
        std::cout << "    " << trace_line(events[i], names) << '\n';
      } else if (i == kTimelineEnds) {
        std::cout << fmt::format("      … {} more\n", events.size() - 2 * kTimelineEnds);
      }
    }
  }

  // The failed step in its line, underlined, with the reason below.
  void print_step(compiler::Span span, const std::string& reason) const {
    const compiler::SourceFile& source = sources_.file(span.file);
    const compiler::Position at = source.position(span.begin);
    const std::size_t start = source.line_start(at.line);
    const compiler::Snippet snippet =
        compiler::make_snippet(source.line(at.line), span.begin - start, span.end - start, '^');
    const std::string number = std::to_string(at.line);
    std::cout << fmt::format("  --> {}:{}:{}\n {} | {}\n {:{}} | {}\n    {}\n", source.name(),
                             at.line, at.column, number, snippet.source, "", number.size(),
                             snippet.marker, reason);
  }

  void add_json(const TestResult& result) const {
    Json test{{"file", file(result.test->span)},
              {"line", line(result.test->span)},
              {"test", result.test->title},
              {"ok", result.failed == nullptr}};
    for (const auto* const reading : result.recording.unseen)
      test["warnings"].push_back(
          {{"line", line(reading->span)}, {"text", why_unseen(result, *reading)}});
    if (result.failed != nullptr) {
      Json timeline = Json::array();
      const TraceNames names{result.recording.image, result.recording.threads,
                             result.recording.origin};
      for (const link::Event& event : around(result))
        timeline.push_back(read_json(trace_json(event, names)));
      test["failure"] = {{"line", line(result.failed->span)},
                         {"step", step(result)},
                         {"reason", result.reason},
                         {"from_us", result.failed->from * kMicroseconds},
                         {"until_us", result.failed->until * kMicroseconds},
                         {"timeline", std::move(timeline)}};
    }
    tally_.tests.push_back(std::move(test));
  }

  const TestOptions& options_;
  const compiler::SourceMap& sources_;
  Tally& tally_;
};

void test_file(const std::string& file, const TestOptions& options, Tally& tally) {
  compiler::Result compiled = compile_file(file, options.how);
  show_diagnostics(compiled, options.quiet);
  if (compiled.diagnostics.errors() > 0) {
    const Json wrong = read_json(compiler::render_json(compiled.diagnostics, compiled.sources));
    for (const Json& one : wrong.at("diagnostics"))
      tally.diagnostics.push_back(one);
    throw Failure(Exit::program,
                  fmt::format("{}: {}; no test was run", file, summary(compiled.diagnostics)));
  }
  Origin origin = origin_of(compiled);
  const Program program(std::move(compiled.image), file, memory_of(compiled.board),
                        std::move(origin));
  if (compiled.tests.tests.empty()) std::cerr << "rsc: " << file << ": there is no TEST in it\n";
  Reporter reporter(options, compiled.sources, tally);
  for (const compiler::test_plan::PlannedTest& test : compiled.tests.tests)
    reporter.report(run_test(program, compiled.tests, test));
}

void test(const TestOptions& options) {
  Tally tally;
  const Exit exit = for_each_file(
      options.files, [&](const std::string& file) { test_file(file, options, tally); });
  if (options.format == Format::json) {
    const Json report{{"tests", tally.tests},
                      {"passed", tally.passed},
                      {"failed", tally.failed},
                      {"diagnostics", tally.diagnostics}};
    std::cout << json_text(report) << '\n';
  } else if (!options.quiet && (exit == Exit::fine || tally.passed + tally.failed > 0)) {
    std::cout << fmt::format("{} passed, {} failed\n", tally.passed, tally.failed);
  }
  const Exit worst = tally.failed > 0 ? std::max(exit, Exit::program) : exit;
  if (worst != Exit::fine) throw Failure(worst, "");
}

}  // namespace

void add_test(Options& options) {
  auto asked = std::make_shared<TestOptions>();
  options.arguments("FILE", asked->files, "programs (.rsl)", Options::Need::required);
  add_compile_options(options, asked->how);
  add_format_option(options, asked->format);
  add_quiet_option(options, asked->quiet, "say nothing about tests that pass");
  options.runs([asked] {
    refuse_pair(asked->quiet && asked->format == Format::json, "--quiet", "--format json");
    test(*asked);
  });
}

}  // namespace robosync::tool
