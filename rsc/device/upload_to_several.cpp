// See upload_to_several.hpp.
#include "rsc/device/upload_to_several.hpp"

#include <algorithm>
#include <exception>
#include <iostream>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include <fmt/format.h>

#include "rsc/device/keeping.hpp"
#include "rsc/failure.hpp"
#include "rsc/json.hpp"

namespace robosync::tool {
namespace {

// One of several robots; each has its own thread.
struct Robot {
  std::string port;
  std::optional<Uploaded> uploaded;
  Exit exit = Exit::fine;
  std::string why_not;  // what rsc would print for this robot alone; empty: it runs the program
};

// A failure only affects this robot.
void serve(Robot& robot, const SendOptions& options, const Program& program) {
  const auto fails = [&robot](Exit exit, const char* why) {
    robot.exit = exit;
    robot.why_not = why;
  };
  try {
    robot.uploaded = upload_to(robot.port, program, options, {});
    expect_passed_trial(options.file, robot.uploaded->kept, program);
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
  threads.clear();  // joins: each ends with an answer or by its timeout
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

// A message may have several lines, but a table row is one line.
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

std::string state_of(const link::Kept& kept, const Program& program) {
  const link::ProgramHash& hash = program.image().header->program_hash;
  return (has_gone_back(kept, hash) ? "" : "running; ") + keeping_text(kept, hash);
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
        robot.exit == Exit::fine ? state_of(robot.uploaded->kept, program)
                                 : in_one_line(robot.why_not));
  }
  std::cout.flush();
  for (const Robot& robot : robots)
    for (const OnBus& device : robot.uploaded ? robot.uploaded->silent : std::vector<OnBus>())
      std::cerr << "warning: " << robot.port << ": " << silent_text(device) << '\n';
}

}  // namespace

void upload_to_several(const SendOptions& options, const Program& program) {
  const std::vector<Robot> robots = serve_all(options, program);
  if (options.format == Format::json) {
    Json list = Json::array();
    for (const Robot& robot : robots)
      list.push_back(json_of(robot, program));
    print_json(list);
  } else {
    print_table(robots, program);
  }
  const Exit worst = std::ranges::max(robots, {}, &Robot::exit).exit;
  if (worst == Exit::fine) return;
  const auto running = std::ranges::count(robots, Exit::fine, &Robot::exit);
  throw Failure(worst,
                fmt::format("{} runs on {} of {} robots", options.file, running, robots.size()));
}

}  // namespace robosync::tool
