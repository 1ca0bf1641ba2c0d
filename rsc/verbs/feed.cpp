// rsc feed READING… --port P [--at TIME] [--scenario S.json] [--upload FILE [--fresh]]
//          [--watch TIME [--record R.jsonl]] [--format human|json] [--key FILE]
#include <algorithm>
#include <chrono>
#include <iostream>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include <fmt/format.h>

#include "rsc/console.hpp"
#include "rsc/device/line_recorder.hpp"
#include "rsc/device/printer.hpp"
#include "rsc/device/uploader.hpp"
#include "rsc/device/watch.hpp"
#include "rsc/failure.hpp"
#include "rsc/output.hpp"
#include "rsc/trace/channels.hpp"
#include "rsc/trace/scenario.hpp"
#include "rsc/verb.hpp"
#include "rsc/verb_options.hpp"
#include "vm/verifier.hpp"

namespace robosync::tool {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds kQueueTimeout{30000};
constexpr milliseconds kQueuePause{5};  // a question and its answer take 4 ms of the line

struct FeedOptions {
  std::vector<std::string> readings;
  std::string scenario, upload, port, key, record;
  CompileOptions how;
  std::optional<milliseconds> at, watch;
  bool fresh = false;
  Format format = Format::human;
};

// "touch.LEVEL=2"
Stimulus parse_stimulus(const std::string& text, std::uint64_t at_us, const vm::Image& image) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos) {
    throw Failure(Exit::usage, fmt::format("`{}` is not a reading; write SENSOR.CHANNEL=VALUE, as "
                                           "in touch.LEVEL=2",
                                           text));
  }
  try {
    const std::uint8_t channel = find_channel(image, text.substr(0, equals));
    return {at_us, channel, parse_reading(image, channel, text.substr(equals + 1))};
  } catch (const std::invalid_argument& error) {
    throw Failure(Exit::program, fmt::format("{}: {}", text, error.what()));
  }
}

std::string describe(link::FeedError error, const vm::Image& image, const Stimulus& stimulus) {
  const vm::Channel& channel = image.channels[stimulus.channel];
  const std::string name = fmt::format("{} {}", image.string(image.sensors[channel.sensor].name),
                                       image.string(channel.name));
  switch (error) {
    case link::FeedError::none:
      break;
    case link::FeedError::no_program:
      return "no program runs on the board";
    case link::FeedError::no_channel:
      return fmt::format("the board has no channel {}", name);
    case link::FeedError::not_virtual:
      return fmt::format("{} is measured by the board; only virtual sensors can be fed", name);
    case link::FeedError::queue_full:
      return "too many readings wait for their time on the board";
    case link::FeedError::in_the_past:
      return fmt::format("the program is already past {} ms", stimulus.at_us / 1000);
  }
  return fmt::format("the board refused the reading of {}", name);
}

// A full queue empties as time goes on.
void send(Session& session, const vm::Image& image, const Stimulus& stimulus) {
  const auto give_up = session.client.now() + kQueueTimeout;
  while (true) {
    const link::Feed feed{
        .channel = stimulus.channel, .at_us = stimulus.at_us, .value = stimulus.value};
    const link::FeedResult result = session.client.feed(feed);
    if (result.error == link::FeedError::none) return;
    if (result.error != link::FeedError::queue_full || session.client.now() >= give_up) {
      throw Failure(Exit::program, describe(result.error, image, stimulus));
    }
    std::this_thread::sleep_for(kQueuePause);
  }
}

std::vector<Stimulus> wanted(const FeedOptions& options, const Program& program) {
  Scenario scenario;
  if (!options.scenario.empty()) scenario = read_scenario(options.scenario, program);
  show_notes(scenario);
  std::vector<Stimulus> stimuli = std::move(scenario.stimuli);
  const auto at_us =
      static_cast<std::uint64_t>(options.at.value_or(milliseconds(0)).count()) * 1000;
  for (const std::string& text : options.readings)
    stimuli.push_back(parse_stimulus(text, at_us, program.image()));
  return stimuli;
}

Program running_program(Session& session) {
  std::vector<std::byte> bytes = session.client.running_image();
  vm::Image image;
  if (bytes.empty()) throw Failure(Exit::program, "no program runs on the board; upload one first");
  if (!vm::verify(bytes, vm::Limits{}, image).ok()) {
    throw Failure(Exit::outside, "the board runs an image that this rsc does not understand");
  }
  return {std::move(bytes), "the running program"};
}

void feed(const FeedOptions& options) {
  if (options.readings.empty() && options.scenario.empty()) {
    throw Failure(Exit::usage, "name a reading, as in touch.LEVEL=2, or a --scenario");
  }
  if (!options.record.empty()) {
    if (!options.watch) throw Failure(Exit::usage, "--record records what --watch TIME shows");
    check_output(options.record, {options.scenario, options.upload});
  }
  std::optional<Program> program;
  if (!options.upload.empty()) program = load_program(options.upload, options.how);
  const Place place{options.port, options.key};
  auto session = open_session(place);
  Printer printer(options.format);
  std::optional<LineRecorder> recorder;
  std::vector<Viewer*> viewers = {&printer};
  if (!options.record.empty()) viewers.push_back(&recorder.emplace(options.record));
  std::optional<Watch> watch;
  if (options.watch) watch.emplace(session, place, viewers);
  if (program) {
    UploadOptions how;
    how.fresh = options.fresh;
    upload_program(*session, *program, how);
  } else {
    program = running_program(*session);
  }
  const vm::Image& image = program->image();
  const std::vector<Stimulus> stimuli = wanted(options, *program);
  for (const Stimulus& stimulus : stimuli)
    send(*session, image, stimulus);
  if (watch) {
    watch->show(options.watch);
  } else if (options.format == Format::human) {
    std::cout << fmt::format("{} reading{} fed\n", stimuli.size(), stimuli.size() == 1 ? "" : "s");
  }
}

}  // namespace

void add_feed(Options& options) {
  auto asked = std::make_shared<FeedOptions>();
  options.arguments("READING", asked->readings, "SENSOR.CHANNEL=VALUE, as in touch.LEVEL=2",
                    Options::Need::optional);
  add_port_option(options, asked->port);
  add_key_option(options, asked->key);
  add_duration_option(options, "--at", asked->at, "program time of the readings; else now");
  options.option("--scenario", "S.json", asked->scenario, "readings with their times");
  options.option("--upload", "FILE", asked->upload,
                 "upload this program (.rsl or .rsb) first; --watch shows all it does");
  options.flag("--fresh", asked->fresh, "with --upload: KEPT numbers begin as the program says");
  add_compile_options(options, asked->how);
  add_duration_option(options, "--watch", asked->watch, "then show what happens for so long");
  options.option("--record", "R.jsonl", asked->record,
                 "with --watch: write it down for rsc replay");
  add_format_option(options, asked->format);
  options.runs([asked] { feed(*asked); });
}

}  // namespace robosync::tool
