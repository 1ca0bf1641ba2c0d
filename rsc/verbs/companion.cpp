// rsc companion --port P [--config robot.json] [--camera DEV|FILE] [--microphone DEV|FILE] [--preview FILE.png]
//               [--programs FOLDER] [--duration TIME] [--key FILE] [--monitor [--format human|json]] [--record R.jsonl]
// rsc companion --list [--format human|json]
#include "rsc/companion/companion.hpp"

#include <chrono>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <system_error>
#include <vector>

#include <fmt/format.h>

#include "rsc/companion_modules.hpp"
#include "rsc/device/line_recorder.hpp"
#include "rsc/device/printer.hpp"
#include "rsc/device/watch.hpp"
#include "rsc/failure.hpp"
#include "rsc/json.hpp"
#include "rsc/output.hpp"
#include "rsc/verb.hpp"
#include "rsc/verb_options.hpp"

namespace robosync::tool {
namespace {

struct CompanionOptions {
  std::string port, key, record, config = "robot.json";
  CompanionSources sources;
  std::optional<std::chrono::milliseconds> duration;
  bool list = false, monitor = false;
  Format format = Format::human;
};

Json json_of(const compiler::AlgorithmModule& module, const std::string& program) {
  Json object;
  object["module"] = module.name;
  object["does"] = doc_of_companion_module(module.name);
  object["device"] = module.device;
  for (const compiler::ModuleOutput& output : module.outputs)
    object["outputs"].push_back(output.name);
  object["program"] = program.empty() ? Json(nullptr) : Json(program);
  return object;
}

void list(const CompanionOptions& options) {
  auto objects = Json::array();
  for (const compiler::AlgorithmModule& module : companion_modules()) {
    const std::string program = find_companion_program(module.name, options.sources.programs);
    if (options.format == Format::json) {
      objects.push_back(json_of(module, program));
      continue;
    }
    std::cout << fmt::format("{:<16} {} (from the {})\n{:<16} ", module.name,
                             doc_of_companion_module(module.name), module.device, "");
    for (const compiler::ModuleOutput& output : module.outputs)
      std::cout << output.name << ' ';
    std::cout << "· " << (program.empty() ? "is not installed" : program) << '\n';
  }
  if (options.format == Format::json) std::cout << json_text(objects) << '\n';
}

// The algorithms of robot.json that run here.
std::vector<compiler::SensorConfig> algorithms_of(const std::string& config) {
  std::vector<compiler::SensorConfig> found = algorithms_in(config, true);
  std::erase_if(found, [](const auto& sensor) { return !sensor.companion; });
  if (found.empty())
    throw Failure(Exit::program, fmt::format("{} has no algorithm that runs on a companion "
                                             "computer; `rsc companion --list` lists them",
                                             config));
  return found;
}

// A path that does not exist is an error; other names are ALSA's, or the number of a camera.
void check_source(const std::string& source) {
  std::error_code error;
  if (source.find('/') != std::string::npos && !std::filesystem::exists(source, error))
    throw Failure(Exit::outside, fmt::format("there is no file or device {}", source));
}

void check_programs(const std::vector<compiler::SensorConfig>& algorithms,
                    const std::string& folder) {
  for (const compiler::SensorConfig& algorithm : algorithms)
    if (find_companion_program(algorithm.companion->module, folder).empty())
      throw Failure(Exit::outside,
                    fmt::format("{}: the program for the module {} is not installed: run "
                                "scripts/companion (docs/companion.md)",
                                algorithm.name.text, algorithm.companion->module));
}

void run(const CompanionOptions& options) {
  if (options.list) {
    list(options);
    return;
  }
  if (options.port.empty()) throw Failure(Exit::usage, "name the --port of the robot, or --list");
  std::vector<compiler::SensorConfig> algorithms = algorithms_of(options.config);
  check_outputs({{options.record, FileKind::replay}, {options.sources.preview}},
                {options.config, options.sources.camera, options.sources.microphone});
  check_source(options.sources.camera);
  check_source(options.sources.microphone);
  check_programs(algorithms, options.sources.programs);
  const Place place{options.port, options.key};
  auto session = open_session(place);
  Companion companion(std::move(algorithms), options.sources, !options.monitor);
  std::vector<Viewer*> viewers = {&companion};
  Printer printer(options.format);
  if (options.monitor) viewers.push_back(&printer);
  std::optional<LineRecorder> recorder;
  if (!options.record.empty()) viewers.push_back(&recorder.emplace(options.record));
  Watch watch(session, place, viewers);
  watch.show(options.duration);
  if (companion.has_failed()) throw Failure(Exit::outside, "no module hears or sees any more");
}

}  // namespace

void add_companion(Options& options) {
  auto asked = std::make_shared<CompanionOptions>();
  options.option("--port", "PORT", asked->port,
                 "of the robot: serial device, pty, unix:PATH or tcp:HOST:PORT (see `rsc ports`)");
  add_key_option(options, asked->key);
  options.option("--config", "FILE", asked->config, "robot.json; else the one in this folder");
  options.option("--camera", "DEV|FILE", asked->sources.camera,
                 "a camera (/dev/video0), a picture or a video; else /dev/video0");
  options.option("--microphone", "DEV|FILE", asked->sources.microphone,
                 "an ALSA microphone (see `arecord -L`), or a sound file; else default");
  options.option("--preview", "FILE.png", asked->sources.preview,
                 "the camera's picture with what was found in it, once a second");
  options.option("--programs", "FOLDER", asked->sources.programs,
                 "where the modules' programs are; else beside rsc or on the PATH");
  add_duration_option(options, "--duration", asked->duration, "how long; else until Ctrl-C");
  options.flag("--monitor", asked->monitor,
               "show what the robot does, like rsc monitor, instead of what it is told");
  add_format_option(options, asked->format);
  options.option("--record", "R.jsonl", asked->record,
                 "record what the robot does, for rsc replay");
  options.flag("--list", asked->list, "list the modules, and which are installed");
  options.runs([asked] { run(*asked); });
}

}  // namespace robosync::tool
