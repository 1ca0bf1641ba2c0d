// rsc upload FILE|X.rsb --port P… [--config FILE] [--timeout TIME] [--trial TIME] [--no-confirm] [--replace] [--fresh]
//            [--anyway] [--take] [--key FILE]
#include <algorithm>
#include <chrono>
#include <exception>
#include <functional>
#include <iostream>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "rsc/console.hpp"
#include "rsc/device/devices.hpp"
#include "rsc/device/keeping.hpp"
#include "rsc/device/known_image.hpp"
#include "rsc/device/serial_transport.hpp"
#include "rsc/device/uploader.hpp"
#include "rsc/failure.hpp"
#include "rsc/verb.hpp"
#include "rsc/verb_options.hpp"

namespace robosync::tool {
namespace {

using std::chrono::milliseconds;
using Json = nlohmann::ordered_json;

constexpr double kBitsPerByte = 10;  // 8N1

struct SendOptions {
  std::string file, key;
  std::vector<std::string> ports;
  CompileOptions how;
  std::optional<milliseconds> timeout, trial;
  bool no_confirm = false;
  bool replace = false;
  bool fresh = false;
  bool anyway = false;
  bool take = false;
  Format format = Format::human;
};

using Progress = std::function<void(std::size_t sent, std::size_t total)>;

// What a robot has got, and how it stands with it.
struct Uploaded {
  UploadResult result;
  std::vector<OnBus> silent;
  link::Kept kept{};
};

void show_progress(std::size_t sent, std::size_t total) {
  std::cerr << fmt::format("\r{} of {} bytes", sent, total);
  if (sent == total) std::cerr << "\r\x1b[K";
  std::cerr.flush();
}

double ms_of(const UploadResult& result) {
  return static_cast<double>(result.time.count()) / 1000;
}

double wire_ms_of(const UploadResult& result) {
  return static_cast<double>(result.bytes) * kBitsPerByte / kBaudRate * 1000;
}

std::string hash_of(const Program& program) {
  return text_of(program.image().header->program_hash);
}

Json json_of(const Uploaded& uploaded, const Program& program) {
  const UploadResult& result = uploaded.result;
  return {{"bytes", result.bytes},
          {"time_ms", ms_of(result)},
          {"wire_time_ms", wire_ms_of(result)},
          {"frames", result.frames_sent},
          {"bytes_sent", result.bytes_sent},
          {"program", hash_of(program)},
          {"uptime_us", result.activation.uptime_us},
          {"silent", devices_json(uploaded.silent)},
          {"kept", keeping_json(uploaded.kept)}};
}

void print(const Json& json) {
  std::cout << json.dump(-1, ' ', false, Json::error_handler_t::replace) << '\n';
}

void report(const SendOptions& options, const Uploaded& uploaded, const Program& program) {
  if (options.format == Format::json) return print(json_of(uploaded, program));
  const UploadResult& result = uploaded.result;
  std::cout << fmt::format(
      "{}: {} bytes in {:.1f} ms ({} sent; all of it takes {:.1f} ms at 115,200 baud); program {} "
      "runs since {:.3f} s after start-up\n",
      options.file, result.bytes, ms_of(result), result.bytes_sent, wire_ms_of(result),
      hash_of(program), static_cast<double>(result.activation.uptime_us) / 1e6);
  std::cout << keeping_text(uploaded.kept) << '\n';
  for (const OnBus& device : uploaded.silent)
    std::cerr << "warning: " << silent_text(device) << '\n';
}

// Throws Failure as Session and upload_program().
Uploaded upload_to(const std::string& port, const Program& program, const SendOptions& options,
                   const Progress& progress) {
  const std::vector<std::byte> base = known_image(port);
  UploadOptions how;
  how.timeout = options.timeout;
  how.trial = options.trial.value_or(milliseconds(0));
  how.confirm = !options.no_confirm;
  how.replace = options.replace;
  how.fresh = options.fresh;
  if (!how.replace) how.base = base;
  how.progress = progress;
  constexpr milliseconds kAnswer{2000};
  Session session(port, std::min(how.timeout.value_or(kAnswer), kAnswer), Greeting::later,
                  options.take);
  session.client.use_key(options.key);
  if (options.no_confirm) expect_kept_program(session.client);
  Uploaded uploaded;
  uploaded.result = upload_program(session, program, how);
  know_image(port, without_source_lines(program));
  uploaded.silent = silent_after_start(session.client, program.image());
  uploaded.kept = options.trial ? after_trial(session.client) : session.client.kept();
  return uploaded;
}

void expect_trial_stood(const SendOptions& options, const Uploaded& uploaded,
                        const Program& program) {
  if (uploaded.kept.given_up_hash == program.image().header->program_hash)
    throw Failure(Exit::program,
                  options.file +
                      " did not stand its trial: a thread of it faulted, or a SAFETY rule tripped "
                      "that did not in the program before; that one runs again");
}

void upload_to_one(const SendOptions& options, const Program& program) {
  const Uploaded uploaded = upload_to(options.ports.front(), program, options,
                                      stderr_is_terminal() ? show_progress : Progress());
  report(options, uploaded, program);
  expect_trial_stood(options, uploaded, program);
}

// One of several robots, each of which has a thread.
struct Robot {
  std::string port;
  std::optional<Uploaded> uploaded;
  Exit exit = Exit::fine;
  std::string why_not;  // what rsc would say of this robot alone; empty: it runs the program
};

// What goes wrong stays with this robot.
void serve(Robot& robot, const SendOptions& options, const Program& program) {
  const auto fails = [&robot](Exit exit, const char* why) {
    robot.exit = exit;
    robot.why_not = why;
  };
  try {
    robot.uploaded = upload_to(robot.port, program, options, {});
    expect_trial_stood(options, *robot.uploaded, program);
  } catch (const Failure& failure) {
    fails(failure.exit(), failure.what());
  } catch (const std::exception& error) {
    fails(Exit::outside, error.what());
  }
}

std::vector<Robot> serve_all(const SendOptions& options, const Program& program) {
  std::vector<Robot> robots;
  robots.reserve(options.ports.size());
  for (const std::string& port : options.ports)
    robots.push_back({port, {}, Exit::fine, {}});
  std::vector<std::jthread> threads;
  threads.reserve(robots.size());
  for (Robot& robot : robots)
    threads.emplace_back([&] { serve(robot, options, program); });
  threads.clear();  // each ends with its answer, or by its timeout
  return robots;
}

Json json_of(const Robot& robot, const Program& program) {
  Json json{{"port", robot.port}};
  if (robot.uploaded) json.update(json_of(*robot.uploaded, program));
  if (robot.exit == Exit::fine) return json;
  json["error"] = robot.why_not;
  json["exit"] = static_cast<int>(robot.exit);
  return json;
}

// Reasons may have a line each, and a row of the table is one.
std::string in_one_line(const std::string& text) {
  std::string line;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    line.append(text, at, end - at);
    at = std::min(text.find_first_not_of("\n ", end), text.size());
    if (at < text.size()) line += line.ends_with(':') ? " " : "; ";
  }
  return line;
}

void print_table(const std::vector<Robot>& robots, const Program& program) {
  std::size_t width = std::string_view("port").size();
  for (const Robot& robot : robots)
    width = std::max(width, robot.port.size());
  const std::string hash = hash_of(program);
  const auto row = [&](std::string_view port, std::string_view name, std::string_view sent,
                       std::string_view ms, std::string_view state) {
    std::cout << fmt::format("{:<{}}  {:<{}}  {:>10}  {:>8}  {}\n", port, width, name, hash.size(),
                             sent, ms, state);
  };
  row("port", "program", "bytes sent", "ms", "state");
  for (const Robot& robot : robots) {
    if (!robot.uploaded) {
      row(robot.port, "-", "-", "-", in_one_line(robot.why_not));
      continue;
    }
    const UploadResult& result = robot.uploaded->result;
    row(robot.port, hash, fmt::to_string(result.bytes_sent), fmt::format("{:.1f}", ms_of(result)),
        robot.exit == Exit::fine ? "running; " + keeping_text(robot.uploaded->kept)
                                 : in_one_line(robot.why_not));
  }
  std::cout.flush();
  for (const Robot& robot : robots)
    for (const OnBus& device : robot.uploaded ? robot.uploaded->silent : std::vector<OnBus>())
      std::cerr << "warning: " << robot.port << ": " << silent_text(device) << '\n';
}

void upload_to_several(const SendOptions& options, const Program& program) {
  const std::vector<Robot> robots = serve_all(options, program);
  if (options.format == Format::json) {
    Json list = Json::array();
    for (const Robot& robot : robots)
      list.push_back(json_of(robot, program));
    print(list);
  } else {
    print_table(robots, program);
  }
  const Exit worst = std::ranges::max(robots, {}, &Robot::exit).exit;
  if (worst == Exit::fine) return;
  const auto running = std::ranges::count(robots, Exit::fine, &Robot::exit);
  throw Failure(worst,
                fmt::format("{} runs on {} of {} robots", options.file, running, robots.size()));
}

// Two threads would each take what the robot answers the other.
void expect_different_lines(const std::vector<std::string>& ports) {
  std::map<std::string, std::string> seen;  // as it was named, by line
  for (const std::string& port : ports) {
    const auto [at, is_new] = seen.emplace(real_name_of(port), port);
    if (is_new) continue;
    const std::string same = at->second == port ? " is there twice" : " is " + at->second;
    throw Failure(Exit::usage, fmt::format("--port {}{}: name each robot once", port, same));
  }
}

void upload(const SendOptions& options) {
  expect_different_lines(options.ports);
  const Program program = load_program(options.file, options.how);
  if (options.ports.size() == 1) return upload_to_one(options, program);
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
                      "give up after (10s, longer for a large image)");
  add_duration_option(options, "--trial", asked->trial,
                      "wait until it has run for so long, and say whether the robot keeps it");
  options.flag("--no-confirm", asked->no_confirm,
               "only try it: after the trial the kept program comes back");
  options.flag("--replace", asked->replace,
               "end the running program first, where the board has no room for both");
  options.flag("--fresh", asked->fresh, "KEPT numbers begin as the program says");
  options.flag("--anyway", asked->anyway,
               "also when it is too much for the board, which may refuse it");
  options.flag("--take", asked->take, "take the line from a host in the midst of an upload");
  add_format_option(options, asked->format);
  options.runs([asked] {
    asked->how.judged = asked->anyway ? Judged::not_at_all : Judged::by_time;
    upload(*asked);
  });
}

}  // namespace robosync::tool
