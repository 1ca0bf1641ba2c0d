// rsc replay T.jsonl [--program FILE [--config FILE]] [--format human|json]
#include "rsc/trace/replay.hpp"

#include <algorithm>
#include <cstddef>
#include <iostream>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "rsc/console.hpp"
#include "rsc/failure.hpp"
#include "rsc/json.hpp"
#include "rsc/trace/time_units.hpp"
#include "rsc/verb.hpp"
#include "rsc/verb_options.hpp"

namespace robosync::tool {
namespace {

struct ReplayOptions {
  std::string file, program;
  CompileOptions how;
  Format format = Format::human;
};

// A recording contains its program, a trace does not.
RecordedRun recording_of(const ReplayOptions& options) {
  RecordedRun run = read_recording(options.file);
  if (run.programs.empty())
    throw Failure(Exit::program, options.file +
                                     ": no program starts in it before any gap: start recording "
                                     "before the upload, and end it "
                                     "after the program has started");
  for (const RecordedProgram& one : run.programs)
    if (one.image.empty() && options.program.empty())
      throw Failure(Exit::usage, fmt::format("{}:{}: the program that starts here is not in it: "
                                             "name it with --program, or record with --record",
                                             options.file, one.line));
  return run;
}

// The image of --program, which runs instead of every recorded one.
std::vector<std::byte> image_of(const ReplayOptions& options) {
  if (options.program.empty()) return {};
  return without_source_lines(load_program(options.program, options.how));
}

void print_program(const ReplayOptions& options, const RecordedProgram& recorded,
                   std::span<const std::byte> image, const Replayed& replayed) {
  if (options.program.empty()) return;
  std::string_view what = "ran instead of the recorded program";
  if (recorded.image.empty()) what = "ran; the recorded program is not known";
  if (std::ranges::equal(image, recorded.image)) what = "is the recorded program";
  std::cout << fmt::format("  {} {}\n", options.program, what);
  if (!replayed.unrecorded.empty())
    std::cout << fmt::format("  it reads {}, which was not recorded and is unknown to it\n",
                             fmt::join(replayed.unrecorded, ", "));
}

void print_human(const ReplayOptions& options, std::size_t number, const RecordedProgram& recorded,
                 std::span<const std::byte> image, const Replayed& replayed) {
  std::cout << fmt::format("program {}: {} events, {} of them commands, {}, until {}\n", number,
                           replayed.events, replayed.commands,
                           replayed.difference ? "then a difference" : "the same as recorded",
                           seconds_text(replayed.until_us));
  if (replayed.late > 0)
    std::cout << fmt::format(
        "  {} of the events were recorded later than in the replay, by at most {} ms\n",
        replayed.late, replayed.latest_us / 1000);
  if (replayed.early > 0)
    std::cout << fmt::format(
        "  {} of the events were recorded earlier than in the replay, by at most {} ms: SAFETY "
        "sees a "
        "reading before the step that tells it\n",
        replayed.early, replayed.earliest_us / 1000);
  print_program(options, recorded, image, replayed);
  if (!recorded.gap.empty())
    std::cout << fmt::format("  from there on the recording has a gap: {}\n", recorded.gap);
  if (!replayed.difference) return;
  const auto shown = [](const std::string& line) { return line.empty() ? "nothing" : line; };
  std::cout << fmt::format(
      "  {}{}: recorded  {}\n", options.file,
      replayed.difference->line == 0 ? "" : fmt::format(":{}", replayed.difference->line),
      shown(replayed.difference->recorded));
  std::cout << fmt::format("  replayed  {}\n", shown(replayed.difference->replayed));
}

Json json_of(const RecordedProgram& recorded, std::span<const std::byte> image,
             const Replayed& replayed) {
  Json report{{"line", recorded.line},
              {"events", replayed.events},
              {"commands", replayed.commands},
              {"until_us", replayed.until_us},
              {"late", replayed.late},
              {"latest_us", replayed.latest_us},
              {"gap", recorded.gap.empty() ? Json(nullptr) : Json(recorded.gap)},
              {"difference", nullptr}};
  report["early"] = replayed.early;
  report["earliest_us"] = replayed.earliest_us;
  const auto parsed = [](const std::string& line) {
    return line.empty() ? Json(nullptr) : read_json(line);
  };
  if (!image.empty()) {
    report["in_its_place"] = !std::ranges::equal(image, recorded.image);
    report["unrecorded"] = replayed.unrecorded;
  }
  if (replayed.difference)
    report["difference"] = {{"line", replayed.difference->line},
                            {"recorded", parsed(replayed.difference->recorded)},
                            {"replayed", parsed(replayed.difference->replayed)}};
  return report;
}

void replay_all(const ReplayOptions& options) {
  if (options.program.empty())
    refuse_alone(given_option(options.how), "--program FILE: without it, nothing is compiled");
  const RecordedRun run = recording_of(options);
  const std::vector<std::byte> image = image_of(options);
  Json reports = Json::array();
  std::size_t differing = 0;
  for (std::size_t i = 0; i < run.programs.size(); ++i) {
    const Replayed replayed = replay(run.programs[i], options.file, image);
    differing += replayed.difference ? 1 : 0;
    if (options.format == Format::json)
      reports.push_back(json_of(run.programs[i], image, replayed));
    else
      print_human(options, i + 1, run.programs[i], image, replayed);
  }
  if (options.format == Format::json)
    std::cout << json_text({{"programs", reports}, {"not_replayed", run.loose}}) << '\n';
  else if (run.loose > 0)
    std::cout << fmt::format(
        "{} events were not replayed: the recording does "
        "not say what led to them\n",
        run.loose);
  if (differing > 0) throw Failure(Exit::program, "");
}

}  // namespace

void add_replay(Options& options) {
  auto asked = std::make_shared<ReplayOptions>();
  options.argument("FILE", asked->file, "a recording from --record, or a trace with --program",
                   Options::Need::required);
  options.option(
      "--program", "FILE", asked->program,
      "program to run instead of the recorded one (.rsl or .rsb); a trace contains none");
  add_compile_options(options, asked->how);
  add_format_option(options, asked->format);
  options.runs([asked] { replay_all(*asked); });
}

}  // namespace robosync::tool
