// rsc run FILE|X.rsb [--scenario S.json] [--duration 10s] [--trace T.jsonl] [--record R.jsonl] [--html OUT.html]
//         [--watch] [--all] [--kept FILE] [--fresh] [--config FILE] [-O0] [--seed N]
#include <algorithm>
#include <chrono>
#include <iostream>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include <fmt/format.h>

#include "rsc/console.hpp"
#include "rsc/failure.hpp"
#include "rsc/interruptible.hpp"
#include "rsc/kept.hpp"
#include "rsc/output.hpp"
#include "rsc/program.hpp"
#include "rsc/saved_files.hpp"
#include "rsc/timeline/page.hpp"
#include "rsc/timeline/recorder.hpp"
#include "rsc/timing.hpp"
#include "rsc/trace/digest.hpp"
#include "rsc/trace/replay_file.hpp"
#include "rsc/trace/scenario.hpp"
#include "rsc/trace/time_units.hpp"
#include "rsc/trace/trace_format.hpp"
#include "rsc/verb.hpp"
#include "rsc/verb_options.hpp"
#include "runtime-m4/kernel/time.hpp"
#include "runtime-m4/sim/simulator.hpp"

namespace robosync::tool {
namespace {

constexpr std::uint64_t kDefaultDurationUs = 10'000'000;
// What the last step sets takes effect in the next one; only its KEPT numbers matter then.
constexpr std::uint64_t kTakesEffectUs = kernel::kTick;
constexpr std::uint64_t kLongestUnaskedUs = std::uint64_t{3600} * 1'000'000;
constexpr std::uint64_t kSliceUs = 100'000;  // after which a run can be interrupted

struct RunOptions {
  std::string file, scenario, trace, record, html, kept;
  CompileOptions how;
  std::optional<std::chrono::milliseconds> duration;
  bool all = false;
  bool fresh = false;
  bool watch = false;
  Format format = Format::human;
};

// Up to the last reading, if no duration is given.
std::uint64_t duration_us(const RunOptions& options, const Scenario& scenario) {
  if (options.duration) return static_cast<std::uint64_t>(options.duration->count()) * 1000;
  if (scenario.duration_us) return *scenario.duration_us;
  const std::uint64_t last_us = scenario.stimuli.empty() ? 0 : scenario.stimuli.back().at_us;
  return std::clamp(last_us, kDefaultDurationUs, kLongestUnaskedUs);
}

// Not if --duration is given.
void note_what_is_late(const RunOptions& options, const Scenario& scenario, std::uint64_t end_us) {
  const auto late = std::ranges::upper_bound(scenario.stimuli, end_us, {}, &Stimulus::at_us);
  const auto count = scenario.stimuli.end() - late;
  if (options.duration || count == 0) return;
  std::cerr << fmt::format(
      "{}: note: the run ends at {}: {} of {} readings come later and have no effect\n",
      options.scenario, seconds_text(end_us), count, scenario.stimuli.size());
}

void note_without_readings(const RunOptions& options, const Program& program) {
  if (!options.scenario.empty() || program.image().sensors.empty()) return;
  std::cerr << fmt::format(
      "{}: note: without a scenario no sensor reports anything; --scenario S.json gives readings "
      "and their times\n",
      options.file);
}

std::vector<std::string> inputs_of(const RunOptions& options, const Program& program,
                                   const Kept& kept) {
  std::vector<std::string> inputs = program.files();
  inputs.push_back(kept.file());
  if (!options.scenario.empty()) inputs.push_back(options.scenario);
  return inputs;
}

// What a run prints while it runs, and the files that it writes.
class RunOutput {
public:
  RunOutput(const RunOptions& options, const Program& program, Kept& kept, std::uint64_t end_us)
      : options_(options),
        program_(program),
        kept_(kept),
        end_us_(end_us),
        names_{&program.image(), {}, &program.origin()},
        digest_(program.image()),
        timeline_(program, names_) {}

  void watch(const sim::Simulator& simulator) { simulator_ = &simulator; }
  void end_at(std::uint64_t end_us) { end_us_ = end_us; }

  void see(const link::Event& event) {
    kept_.see(event);
    if (names_thread(event)) names_.threads = simulator_->threads();  // with their present ranks
    if (event.time_us > end_us_) return;
    const std::string json = trace_json(event, names_) + "\n";
    if (!options_.trace.empty() || !options_.record.empty()) trace_ += json;
    if (!options_.html.empty()) timeline_.see(event);
    if (options_.format == Format::json)
      std::cout << json;
    else if (options_.all || digest_.shows(event))
      std::cout << trace_line(event, names_) << '\n';
  }

  // `image`: the one that ran.
  void write(std::span<const std::byte> image) {
    kept_.write();
    if (!options_.record.empty()) {
      const std::string recording = image_line(image) + trace_;
      write_output(options_.record, std::as_bytes(std::span(recording)));
    }
    if (!options_.trace.empty()) write_output(options_.trace, std::as_bytes(std::span(trace_)));
    if (options_.html.empty()) return;
    const std::string page =
        timeline_page(options_.file, timeline_.finish(end_us_), program_.source());
    write_output(options_.html, std::as_bytes(std::span(page)));
  }

private:
  const RunOptions& options_;
  const Program& program_;
  Kept& kept_;
  std::uint64_t end_us_;
  const sim::Simulator* simulator_ = nullptr;  // set before any thread runs
  TraceNames names_;
  Digest digest_;
  std::string trace_;
  TimelineRecorder timeline_;
};

// Ctrl-C ends a run at that moment as --duration does. The result is the time of the end.
std::uint64_t run_until(std::uint64_t end_us, sim::Simulator& simulator, RunOutput& output) {
  std::uint64_t now_us = 0;
  while (now_us < end_us && !Interruptible::interrupted())
    simulator.run_until(now_us = std::min(now_us + kSliceUs, end_us));
  output.end_at(now_us);
  simulator.run_until(now_us + kTakesEffectUs);
  return now_us;
}

void run(const RunOptions& options) {
  const Program program = load_program(options.file, options.how);
  Scenario scenario;
  if (!options.scenario.empty()) scenario = read_scenario(options.scenario, program);
  show_notes(scenario);

  Kept kept(program, options.file, options.kept, options.fresh);
  check_outputs({{options.trace}, {options.record, FileKind::replay}, {options.html}},
                inputs_of(options, program, kept));

  std::vector<std::byte> uploaded = without_source_lines(program);  // as on the board
  kept.put_into(uploaded);
  const std::uint64_t end_us = duration_us(options, scenario);
  RunOutput output(options, program, kept, end_us);
  const auto see = [&](const link::Event& event) { output.see(event); };
  sim::Simulator simulator(uploaded, see, program.board(), options.how.seed);
  output.watch(simulator);
  if (const vm::Verdict verdict = simulator.verdict(); !verdict.ok()) {
    throw Failure(Exit::program,
                  fmt::format("{}: the board would refuse it: {}", options.file,
                              refusal_text(program.image(), verdict, program.board())));
  }
  for (const Stimulus& stimulus : scenario.stimuli)
    simulator.feed(stimulus.at_us, stimulus.channel, stimulus.value);
  const Interruptible interruptible;
  note_without_readings(options, program);
  note_what_is_late(options, scenario, end_us);
  const std::uint64_t ended_us = run_until(end_us, simulator, output);
  output.write(uploaded);
  std::cout.flush();
  if (ended_us < end_us)
    std::cerr << fmt::format("{}: note: interrupted; the run ended at {}\n", options.file,
                             seconds_text(ended_us));
  interruptible.pass_on();
}

// False: the user ended it. The same signals also end a long run, as without --watch.
bool waits_until_saved(SavedFiles& saved) {
  constexpr std::chrono::milliseconds kBetweenLooks{100};
  const Interruptible waiting;
  std::cerr << "rsc: waiting until a file is saved; Ctrl-C ends it\n";
  while (!Interruptible::interrupted()) {
    if (saved.changed()) return true;
    std::this_thread::sleep_for(kBetweenLooks);
  }
  return false;
}

// Until the user ends it. Errors are printed, and can be fixed meanwhile.
void run_again_and_again(const RunOptions& options) {
  SavedFiles saved;
  do {
    std::vector<std::string> files = files_of_program(options.file, options.how);
    files.push_back(options.scenario);
    saved.look_at(files);
    try {
      run(options);
    } catch (const Failure& failure) {
      if (failure.exit() == Exit::usage) throw;
      std::cerr << "rsc: " << failure.what() << '\n';
    }
    std::cout.flush();
    if (!std::cout) throw Failure(Exit::outside, "could not write to stdout");
  } while (waits_until_saved(saved));
}

}  // namespace

void add_run(Options& options) {
  auto asked = std::make_shared<RunOptions>();
  options.argument("FILE", asked->file, "program (.rsl) or image (.rsb)", Options::Need::required);
  options.option("--scenario", "S.json", asked->scenario, "what the sensors measure, and when");
  add_duration_option(options, "--duration", asked->duration,
                      "how long; else the scenario's, else 10s or to its last reading");
  options.option("--trace", "T.jsonl", asked->trace, "write the trace as JSON lines");
  options.option("--record", "R.jsonl", asked->record, "record it for rsc replay");
  options.option("--html", "OUT.html", asked->html, "write a web page that shows the run");
  options.flag("--watch", asked->watch,
               "run again whenever the program, its configuration or the "
               "scenario is saved");
  options.flag("--all", asked->all, "also show readings and what happens inside");
  options.option("--kept", "K.json", asked->kept,
                 "file of the KEPT numbers; else STEM.kept.json beside the program");
  options.flag("--fresh", asked->fresh, "KEPT numbers start as the program says");
  add_compile_options(options, asked->how);
  add_seed_option(options, asked->how.seed);
  add_format_option(options, asked->format);
  options.runs([asked] {
    asked->how.json = asked->format == Format::json;
    asked->watch ? run_again_and_again(*asked) : run(*asked);
  });
}

}  // namespace robosync::tool
