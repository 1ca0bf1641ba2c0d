// rsc feed READING… --port P [--at TIME] [--scenario S.json] [--upload FILE [--fresh]]
//          [--anyway] [--watch TIME [--record R.jsonl]] [--format human|json] [--key FILE]
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
#include "rsc/device/keeping.hpp"
#include "rsc/device/line_recorder.hpp"
#include "rsc/device/printer.hpp"
#include "rsc/device/robot_upload.hpp"
#include "rsc/device/uploader.hpp"
#include "rsc/device/watch.hpp"
#include "rsc/failure.hpp"
#include "rsc/interruptible.hpp"
#include "rsc/json.hpp"
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
constexpr milliseconds kQueuePause{5};  // a request and its reply take 4 ms on the line
constexpr milliseconds kShow{100};      // at the latest so long after it happens
constexpr std::uint64_t kFirstMomentsUs = 1'000'000;
constexpr std::uint64_t kLeadUs = 50'000;  // time to send a dozen readings before the first is due

struct FeedOptions {
  std::vector<std::string> readings;
  std::string scenario, upload, port, key, record;
  CompileOptions how;
  std::optional<milliseconds> at, watch;
  bool fresh = false;
  bool anyway = false;
  Format format = Format::human;
};

// "touch.LEVEL=2"
Stimulus parse_stimulus(const std::string& text, std::uint64_t at_us, const vm::Image& image) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || text.find_first_of("=.") == 0) {
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
      return "too many readings are waiting on the board";
    case link::FeedError::in_the_past:
      return fmt::format("the program is already past {} ms", stimulus.at_us / 1000);
  }
  return fmt::format("the board refused the reading of {}", name);
}

// Sends readings, each in time if the line is fast enough. Ends early when the user interrupts.
class Feeder {
public:
  // `watch` shows meanwhile what the board does; may be null.
  Feeder(Session& session, const vm::Image& image, Watch* watch)
      : session_(session),
        image_(image),
        watch_(watch),
        listens_at_(session.client.now() + kShow) {}

  // Times of the scenario count from program time `from_us`, which may be slightly in the past: readings due right after a
  // program starts cannot arrive in time, so they are sent as soon as possible.
  void play(const std::vector<Stimulus>& scenario, std::uint64_t from_us) {
    read_clock();
    for (Stimulus stimulus : scenario) {
      const bool is_early = stimulus.at_us <= kFirstMomentsUs;
      stimulus.at_us += from_us;
      last_due_us_ = std::max(last_due_us_, stimulus.at_us);
      if (is_ended_) return;
      if (is_early && hand_over_early(stimulus)) continue;
      if (!hand_over(stimulus))
        throw Failure(Exit::program,
                      describe(link::FeedError::in_the_past, image_, stimulus) +
                          ": the scenario has more readings than the line takes in that time");
    }
  }

  // For the time given by --at, or for now.
  void feed(const Stimulus& stimulus) {
    if (is_ended_) return;
    last_due_us_ = std::max(last_due_us_, stimulus.at_us);
    if (!hand_over(stimulus))
      throw Failure(Exit::program,
                    describe(link::FeedError::in_the_past, image_, stimulus) +
                        ": --at is a program time; without it the readings are for now");
  }

  void note_late() const {
    if (late_ == 0) return;
    std::cerr << fmt::format(
        "note: {} reading{} due right at the start came a little late, as soon as the line took "
        "{}\n",
        late_, late_ == 1 ? "" : "s", late_ == 1 ? "it" : "them");
  }

  [[nodiscard]] bool is_ended() const { return is_ended_; }
  [[nodiscard]] std::size_t sent() const { return sent_; }

  // Until the last one is due.
  milliseconds rest() {
    if (last_due_us_ == 0) return milliseconds(0);
    read_clock();
    return milliseconds(last_due_us_ > program_us_ ? (last_due_us_ - program_us_) / 1000 : 0);
  }

private:
  void read_clock() {
    program_us_ = session_.client.status().program_us;
    read_at_ = session_.client.now();
  }

  // By the board's clock: an emulated one may be slow.
  bool is_due(const Stimulus& stimulus) {
    read_clock();
    return stimulus.at_us <= program_us_;
  }

  std::uint64_t program_us() const {
    const auto passed = session_.client.now() - read_at_;
    return program_us_ + static_cast<std::uint64_t>(
                             std::chrono::duration_cast<std::chrono::microseconds>(passed).count());
  }

  // Always true: in time or late.
  bool hand_over_early(const Stimulus& stimulus) {
    if (stimulus.at_us > program_us() && hand_over(stimulus)) return true;
    if (stimulus.at_us != 0) ++late_;
    return hand_over({0, stimulus.channel, stimulus.value});
  }

  // False if its time has passed. True also if it is not sent because the user interrupts. A full queue empties as time passes: until
  // this reading is due, those before it may fill it.
  bool hand_over(const Stimulus& stimulus) {
    const auto give_up = session_.client.now() + kQueueTimeout;
    const link::Feed feed{
        .channel = stimulus.channel, .at_us = stimulus.at_us, .value = stimulus.value};
    while (!is_ended_) {
      const link::FeedResult result = session_.client.feed(feed);
      if (result.error == link::FeedError::in_the_past) return false;
      const bool is_full = result.error == link::FeedError::queue_full;
      if (result.error == link::FeedError::none) {
        ++sent_;
      } else if (!is_full || (session_.client.now() >= give_up && is_due(stimulus))) {
        throw Failure(Exit::program, describe(result.error, image_, stimulus));
      }
      pass_time(is_full);
      if (!is_full) return true;
    }
    return true;
  }

  // Listening may take some requests, so the first readings come first, and a full queue has the most time for it.
  void pass_time(bool is_full) {
    if (watch_ == nullptr) {
      if (is_full) std::this_thread::sleep_for(kQueuePause);
      return;
    }
    if (!is_full && session_.client.now() < listens_at_) return;
    is_ended_ = !watch_->listen(is_full ? kQueuePause : milliseconds(0));
    listens_at_ = session_.client.now() + kShow;
  }

  Session& session_;
  const vm::Image& image_;
  Watch* watch_;
  Transport::Clock::time_point listens_at_;
  bool is_ended_ = false;
  std::size_t sent_ = 0;
  std::uint64_t program_us_ = 0, last_due_us_ = 0;
  Transport::Clock::time_point read_at_;
  std::size_t late_ = 0;
};

struct Wanted {
  std::vector<Stimulus> scenario, readings;
};

Wanted wanted(const FeedOptions& options, const Program& program) {
  Wanted wanted;
  if (!options.scenario.empty()) {
    Scenario scenario = read_scenario(options.scenario, program);
    show_notes(scenario);
    wanted.scenario = std::move(scenario.stimuli);
  }
  const auto at_us =
      static_cast<std::uint64_t>(options.at.value_or(milliseconds(0)).count()) * 1000;
  for (const std::string& text : options.readings) {
    const Stimulus reading = parse_stimulus(text, at_us, program.image());
    wanted.readings.push_back(reading);
    if (const auto note = range_note(program, reading.channel, reading.value); !note.empty())
      std::cerr << "note: " << note << '\n';
  }
  return wanted;
}

// A reading that fits another program may be meant for one that the board has given up.
Wanted wanted_of_running(const FeedOptions& options, Session& session, const Program& program) {
  try {
    return wanted(options, program);
  } catch (const Failure& failure) {
    if (failure.exit() != Exit::program) throw;
    const link::Kept kept = session.client.kept();
    const bool still_runs = kept.given_up_hash == program.image().header->program_hash;
    if (kept.given_up_hash == link::ProgramHash{} || still_runs) throw;
    throw Failure(
        failure.exit(),
        followed_by(failure.what(),
                    fmt::format("Program {}, which was uploaded before, failed its trial: "
                                "the robot returned to the program kept before",
                                text_of(kept.given_up_hash))));
  }
}

// A newly started program is fed by its own time, a running one from now on.
std::uint64_t begin_of_scenario(const FeedOptions& options, Session& session) {
  if (!options.upload.empty()) return 0;
  return session.client.status().program_us / 1000 * 1000 + kLeadUs;
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

// Gives the viewers the uploaded program.
class Source final : public Viewer {
public:
  explicit Source(const std::optional<Program>& program) : program_(program) {}
  [[nodiscard]] const Program* uploaded(const link::ProgramHash& hash) const override {
    return program_ && program_->image().header->program_hash == hash ? &*program_ : nullptr;
  }

private:
  const std::optional<Program>& program_;
};

void check_what_is_asked(const FeedOptions& options) {
  if (options.readings.empty() && options.scenario.empty()) {
    throw Failure(Exit::usage, "name a reading, as in touch.LEVEL=2, or a --scenario");
  }
  if (options.upload.empty()) {
    constexpr const char* upload = "--upload FILE: without it, nothing is uploaded";
    refuse_alone(options.fresh ? "--fresh" : nullptr, upload);
    refuse_alone(options.anyway ? "--anyway" : nullptr, upload);
    refuse_alone(given_option(options.how), upload);
  }
  if (options.record.empty()) return;
  if (!options.watch) throw Failure(Exit::usage, "--record records what --watch TIME shows");
  check_output({options.record, FileKind::replay}, {options.scenario, options.upload});
}

UploadOptions how_to_upload(const FeedOptions& options) {
  UploadOptions how;
  how.fresh = options.fresh;
  how.to_any_robot = options.anyway;
  return how;
}

// The user may interrupt what the watch shows. What a line that fails has brought is shown, too.
void send(Feeder& feeder, const Wanted& stimuli, std::uint64_t begin_us,
          std::optional<Watch>& watch) {
  std::optional<Interruptible> interruptible;
  if (watch) interruptible.emplace();
  try {
    if (!stimuli.scenario.empty()) feeder.play(stimuli.scenario, begin_us);
    for (const Stimulus& stimulus : stimuli.readings)
      feeder.feed(stimulus);
  } catch (const Failure&) {
    if (watch) watch->tell_the_rest();
    throw;
  }
}

void say_fed(std::size_t count, Format format) {
  if (format == Format::json)
    std::cout << json_text({{"fed", count}}) << '\n';
  else
    std::cout << fmt::format("{} reading{} fed\n", count, count == 1 ? "" : "s");
}

// Errors in the scenario are reported before anything is uploaded.
void feed(const FeedOptions& options) {
  check_what_is_asked(options);
  std::optional<Program> program;
  Wanted stimuli;
  if (!options.upload.empty()) {
    program = load_program(options.upload, options.how);
    stimuli = wanted(options, *program);
  }
  const Place place{options.port, options.key};
  auto session = open_session(place);
  Printer printer(options.format);
  std::optional<LineRecorder> recorder;
  Source source(program);
  std::vector<Viewer*> viewers = {&source, &printer};
  if (!options.record.empty()) viewers.push_back(&recorder.emplace(options.record));
  std::optional<Watch> watch;
  if (options.watch) watch.emplace(session, place, viewers);
  if (program) {
    upload_program(*session, *program, how_to_upload(options));
  } else {
    program = running_program(*session);
    stimuli = wanted_of_running(options, *session, *program);
  }
  Feeder feeder(*session, program->image(), watch ? &*watch : nullptr);
  const std::uint64_t begin_us =
      stimuli.scenario.empty() ? 0 : begin_of_scenario(options, *session);
  send(feeder, stimuli, begin_us, watch);
  feeder.note_late();
  const std::size_t count = stimuli.scenario.size() + stimuli.readings.size();
  if (feeder.is_ended()) {
    watch->show(milliseconds(0));
    std::cerr << fmt::format("note: ended after {} of {} readings\n", feeder.sent(), count);
  } else if (watch) {
    watch->show(*options.watch + feeder.rest());
    if (!options.upload.empty())
      expect_passed_trial(options.upload, session->client.kept(), *program);
  } else {
    say_fed(count, options.format);
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
  options.option("--scenario", "S.json", asked->scenario,
                 "readings with their times: program time with --upload, else from now");
  options.option("--upload", "FILE", asked->upload,
                 "upload this program (.rsl or .rsb) first; --watch shows all it does");
  options.flag("--fresh", asked->fresh, "with --upload: variables start as the program says");
  options.flag("--anyway", asked->anyway,
               "with --upload: even if it is too much for the board, which may refuse it, or is "
               "for another robot");
  add_compile_options(options, asked->how);
  add_duration_option(options, "--watch", asked->watch,
                      "show what happens until this long after the last reading is due");
  options.option("--record", "R.jsonl", asked->record, "with --watch: record it for rsc replay");
  add_format_option(options, asked->format);
  options.runs([asked] {
    asked->how.judged = asked->anyway ? Judged::not_at_all : Judged::by_time;
    feed(*asked);
  });
}

}  // namespace robosync::tool
