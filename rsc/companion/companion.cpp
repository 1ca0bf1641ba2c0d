// See companion.hpp.
#include "rsc/companion/companion.hpp"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <sstream>
#include <utility>

#include <fmt/format.h>
#include <unistd.h>

#include "compiler/config/robot_reader.hpp"
#include "compiler/diagnostics/render.hpp"
#include "compiler/source/ascii.hpp"
#include "rsc/algorithm_modules.hpp"
#include "rsc/companion/said.hpp"
#include "rsc/companion_modules.hpp"
#include "rsc/console.hpp"
#include "rsc/failure.hpp"
#include "rsc/files.hpp"

namespace robosync::tool {
namespace {

namespace fs = std::filesystem;
using std::chrono::milliseconds;

constexpr int kMostAtOnce = 4;  // readings of an output between two reads of the line
constexpr const char* kUsualCamera = "/dev/video0";
constexpr const char* kUsualMicrophone = "default";

void report(const std::string& who, const std::string& what) {
  std::cerr << fmt::format("rsc: {}: {}\n", who, what);
}

const compiler::AlgorithmModule& module_of(const compiler::SensorConfig& algorithm) {
  const auto modules = companion_modules();
  return *std::ranges::find(modules, algorithm.companion->module, &compiler::AlgorithmModule::name);
}

std::string decimal(vm::Value thousandths) {
  return fmt::format("{:.3f}", static_cast<double>(thousandths) / vm::kScale);
}

std::optional<std::uint8_t> channel_of(const vm::Image& image, std::string_view sensor,
                                       std::string_view channel) {
  for (std::size_t i = 0; i < image.channels.size(); ++i)
    if (compiler::ascii::same(image.string(image.channels[i].name), channel) &&
        compiler::ascii::same(image.string(image.sensors[image.channels[i].sensor].name), sensor))
      return static_cast<std::uint8_t>(i);
  return std::nullopt;
}

}  // namespace

std::string find_companion_program(const std::string& module, const std::string& folder) {
  std::string name = "robosync-" + module;
  std::ranges::replace(name, '_', '-');
  std::vector<fs::path> places = {folder};
  if (folder.empty()) {
    std::error_code error;
    const fs::path here = fs::read_symlink("/proc/self/exe", error).parent_path();
    places = {here, here.parent_path() / "companion/bin"};
    const char* const path = std::getenv("PATH");
    std::istringstream parts(path != nullptr ? path : "");
    for (std::string part; std::getline(parts, part, ':');)
      places.emplace_back(part);
  }
  for (const fs::path& place : places)
    if (!place.empty() && access((place / name).c_str(), X_OK) == 0)
      return fs::absolute(place / name).string();
  return {};
}

std::vector<compiler::SensorConfig> algorithms_in(const std::string& config, bool reads_words) {
  compiler::SourceMap sources;
  compiler::Diagnostics diagnostics;
  const compiler::FileId file = sources.add(config, read_text(config));
  compiler::AlgorithmModules modules = algorithm_modules();
  if (!reads_words) modules.words_in_file = nullptr;
  auto robot = compiler::read_robot(sources, file, diagnostics, modules);
  if (diagnostics.errors() != 0 || !robot) {
    std::cerr << compiler::render_human(diagnostics, sources, color_on_stderr());
    throw Failure(Exit::program, "");
  }
  std::erase_if(robot->sensors,
                [](const auto& sensor) { return !sensor.companion && !sensor.algorithm; });
  return std::move(robot->sensors);
}

Companion::Companion(std::vector<compiler::SensorConfig> algorithms, CompanionSources sources,
                     bool tells)
    : sources_(std::move(sources)), tells_(tells) {
  for (compiler::SensorConfig& algorithm : algorithms)
    hearers_.push_back({std::move(algorithm), nullptr, {}});
}

Companion::~Companion() = default;

// ---- which programs run

void Companion::program(const TraceNames& names, std::span<const std::byte> /*image*/) {
  image_ = names.image;
  for (Hearer& hearer : hearers_)
    connect(hearer);
}

// A program whose plan is unchanged is not restarted.
void Companion::connect(Hearer& hearer) {
  hearer.outputs.clear();
  const std::string& name = hearer.algorithm.name.text;
  for (const compiler::ChannelConfig& config : hearer.algorithm.channels) {
    const auto channel =
        image_ != nullptr ? channel_of(*image_, name, config.name.text) : std::nullopt;
    if (!channel) continue;
    const vm::Channel& record = image_->channels[*channel];
    hearer.outputs.push_back({config.name.text, *channel,
                              Outlet(record.label_count != 0, milliseconds(record.stale_ms)),
                              std::nullopt});
  }
  if (hearer.outputs.empty()) {
    hearer.worker.reset();
    report(name, image_ == nullptr ? "no program runs on the robot"
                                   : "the program that runs on the robot does not read it");
    return;
  }
  Worker::Plan plan = plan_of(hearer);
  if (hearer.worker && hearer.worker->plan() == plan) return;
  hearer.worker = std::make_unique<Worker>(std::move(plan),
                                           [name](const std::string& what) { report(name, what); });
}

Worker::Plan Companion::plan_of(const Hearer& hearer) const {
  const compiler::CompanionConfig& config = *hearer.algorithm.companion;
  const compiler::AlgorithmModule& module = module_of(hearer.algorithm);
  const bool sees = module.device == "camera";
  const std::string& source = sees ? sources_.camera : sources_.microphone;
  std::vector<std::string> arguments = {"--source",
                                        !source.empty() ? source
                                        : sees          ? kUsualCamera
                                                        : kUsualMicrophone,
                                        "--period", std::to_string(config.period_ms)};
  for (std::size_t i = 0; i < module.parameters.size(); ++i)
    arguments.insert(arguments.end(),
                     {"--" + module.parameters[i].name, decimal(config.config[i])});
  if (const std::string& words = hearer.algorithm.words_file; !words.empty())
    arguments.insert(arguments.end(), {"--words", words});
  if (sees && !sources_.preview.empty())
    arguments.insert(arguments.end(), {"--preview", sources_.preview});
  for (const Output& output : hearer.outputs) {
    const vm::Channel& channel = image_->channels[output.channel];
    for (std::size_t i = 0; i < channel.label_count; ++i)
      arguments.insert(
          arguments.end(),
          {"--word", std::string(image_->string(image_->labels[channel.first_label + i]))});
  }
  return {hearer.algorithm.name.text, find_companion_program(module.name, sources_.programs),
          std::move(arguments), milliseconds(config.period_ms)};
}

// ---- what they send

// True: the line is of one of its outputs, whether the robot reads that or not.
bool Companion::take(Hearer& hearer, const std::string& line) const {
  const auto said = parse_said(line);
  if (!said) return false;
  for (Output& output : hearer.outputs) {
    if (output.name != said->output) continue;
    const auto value = parse_value(*image_, image_->channels[output.channel], said->value);
    if (value) output.outlet.said(*value);
    return value.has_value();
  }
  return std::ranges::any_of(hearer.algorithm.channels, [&](const compiler::ChannelConfig& config) {
    return config.name.text == said->output;
  });
}

bool Companion::work(Session* session) {
  const bool has_line = session != nullptr && image_ != nullptr;
  bool goes_on = false;
  for (Hearer& hearer : hearers_) {
    if (!hearer.worker) {
      goes_on = true;  // another program may read it
      continue;
    }
    hearer.worker->look(Worker::Clock::now(),
                        [&](const std::string& line) { return take(hearer, line); });
    goes_on = goes_on || !(hearer.worker->is_over() || hearer.worker->is_given_up());
    for (Output& output : hearer.outputs)
      if (!has_line) output.outlet.forget();
  }
  if (has_line) feed(*session);
  return goes_on;
}

bool Companion::has_failed() const {
  return std::ranges::all_of(
      hearers_, [](const Hearer& hearer) { return hearer.worker && hearer.worker->is_given_up(); });
}

// ---- what the robot is fed

// A line failure is left to the watch.
void Companion::feed(Session& session) {
  try {
    for (Hearer& hearer : hearers_)
      for (Output& output : hearer.outputs)
        for (int i = 0; i < kMostAtOnce; ++i)
          if (const auto value = output.outlet.next(Outlet::Clock::now()))
            feed_one(session, hearer, output, *value);
  } catch (const Failure& failure) {
    if (failure.exit() != Exit::outside) throw;
  }
}

void Companion::feed_one(Session& session, const Hearer& hearer, Output& output, vm::Value value) {
  const link::FeedResult result =
      session.client.feed({.channel = output.channel, .at_us = 0, .value = value});
  if (result.error == link::FeedError::not_virtual)
    throw Failure(Exit::program, fmt::format("{} {} is measured by the robot, whose program was "
                                             "compiled with another robot.json: upload it again",
                                             hearer.algorithm.name.text, output.name));
  // Otherwise the robot is busy, or has just started another program.
  if (result.error == link::FeedError::none) show(hearer, output, value);
}

void Companion::show(const Hearer& hearer, Output& output, vm::Value value) const {
  if (!tells_ || output.shown == value) return;
  output.shown = value;
  const vm::Channel& channel = image_->channels[output.channel];
  const auto word = static_cast<std::size_t>(value / vm::kScale);
  std::cout << fmt::format("{} {} {}\n", hearer.algorithm.name.text, output.name,
                           channel.label_count != 0
                               ? image_->string(image_->labels[channel.first_label + word])
                               : decimal(value))
            << std::flush;
}

void Companion::missed(const std::string& why) {
  report("robot", why);
}

}  // namespace robosync::tool
