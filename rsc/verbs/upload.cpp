// rsc upload FILE|X.rsb --port P… [--config FILE] [--timeout TIME] [--trial TIME] [--no-confirm] [--replace] [--fresh]
//            [--anyway] [--take] [--key FILE]
#include <chrono>
#include <iostream>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "rsc/console.hpp"
#include "rsc/device/keeping.hpp"
#include "rsc/device/robot_upload.hpp"
#include "rsc/device/transport.hpp"
#include "rsc/device/upload_to_several.hpp"
#include "rsc/failure.hpp"
#include "rsc/verb.hpp"
#include "rsc/verb_options.hpp"

namespace robosync::tool {
namespace {

constexpr std::chrono::seconds kLeastTimeout{1};

void show_progress(std::size_t sent, std::size_t total) {
  std::cerr << fmt::format("\r{} of {} bytes", sent, total);
  if (sent == total) std::cerr << "\r\x1b[K";
  std::cerr.flush();
}

void report(const SendOptions& options, const Uploaded& uploaded, const Program& program) {
  if (options.format == Format::json) return print_json(json_of(uploaded, program));
  const UploadResult& result = uploaded.result;
  std::cout << fmt::format(
      "{}: {} bytes in {:.1f} ms ({} sent; all of it takes {:.1f} ms at 115,200 baud); program {} "
      "runs since {:.3f} s after start-up\n",
      options.file, result.bytes, ms_of(result), result.bytes_sent, wire_ms_of(result),
      hash_of(program), static_cast<double>(result.activation.uptime_us) / 1e6);
  std::cout << keeping_text(uploaded.kept, program.image().header->program_hash) << '\n';
  for (const OnBus& device : uploaded.silent)
    std::cerr << "warning: " << silent_text(device) << '\n';
}

void upload_to_one(const SendOptions& options, const Program& program) {
  const Uploaded uploaded = upload_to(options.ports.front(), program, options,
                                      stderr_is_terminal() ? show_progress : Progress());
  report(options, uploaded, program);
  expect_passed_trial(options.file, uploaded.kept, program);
}

// Otherwise two threads would each take replies meant for the other.
void expect_different_lines(const std::vector<std::string>& ports) {
  std::map<std::string, std::string> seen;  // the name as given, by line
  for (const std::string& port : ports) {
    const auto [at, is_new] = seen.emplace(real_name_of(port), port);
    if (is_new) continue;
    const std::string same = at->second == port ? " is given twice" : " is " + at->second;
    throw Failure(Exit::usage, fmt::format("--port {}{}: name each robot once", port, same));
  }
}

// A name tells robots apart, so that a wrong --port does not put one robot's program on another.
void expect_no_name(const SendOptions& options, const Program& program) {
  const std::string_view name = program.image().robot_name();
  if (name.empty() || options.anyway) return;
  throw Failure(
      Exit::usage,
      fmt::format("{} is for the robot \"{}\", says its robot.json (\"name\"), and {} robots would "
                  "all get this name: "
                  "upload to each with a robot.json of its own (--config), or leave out \"name\"; "
                  "--anyway gives all of them the name. Nothing was sent",
                  options.file, name, options.ports.size()));
}

// A program is compiled with its seed.
void expect_seed(const SendOptions& options, const Program& program) {
  if (options.how.seed != 0 && options.how.seed != program.image().header->seed)
    refuse_with_image("--seed", options.file);
}

void upload(const SendOptions& options) {
  expect_different_lines(options.ports);
  const Program program = load_program(options.file, options.how);
  expect_seed(options, program);
  if (options.ports.size() == 1) return upload_to_one(options, program);
  expect_no_name(options, program);
  upload_to_several(options, program);
}

}  // namespace

void add_upload(Options& options) {
  auto asked = std::make_shared<SendOptions>();
  options.argument("FILE", asked->file, "program (.rsl) or image (.rsb)", Options::Need::required);
  add_ports_option(options, asked->ports);
  add_key_option(options, asked->key);
  add_compile_options(options, asked->how);
  add_seed_option(options, asked->how.seed);
  add_duration_option(options, "--timeout", asked->timeout,
                      "give up after this time, even if the board still answers; at least 1s");
  add_duration_option(options, "--trial", asked->trial,
                      "wait until it has run this long, and say whether the robot keeps it");
  options.flag("--no-confirm", asked->no_confirm,
               "only try it: the kept program comes back after the trial");
  options.flag("--replace", asked->replace,
               "end the running program first, if the board has no room for both");
  options.flag("--fresh", asked->fresh, "variables start as the program says");
  options.flag(
      "--anyway", asked->anyway,
      "even if it is too much for the board, which may refuse it, or is for another robot");
  options.flag("--take", asked->take, "take the line from a host that is uploading");
  add_format_option(options, asked->format);
  options.runs([asked] {
    if (asked->timeout.value_or(kLeastTimeout) < kLeastTimeout)
      throw Failure(Exit::usage, "--timeout: a board may need 1s to answer; give it at least that");
    asked->how.judged = asked->anyway ? Judged::not_at_all : Judged::by_time;
    upload(*asked);
  });
}

}  // namespace robosync::tool
