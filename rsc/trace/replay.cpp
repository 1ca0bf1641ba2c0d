// See replay.hpp.
#include "rsc/trace/replay.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <map>
#include <set>
#include <stdexcept>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "rsc/failure.hpp"
#include "rsc/program.hpp"
#include "rsc/trace/channels.hpp"
#include "rsc/trace/event_reader.hpp"
#include "rsc/trace/time_units.hpp"
#include "rsc/trace/trace_format.hpp"
#include "runtime-m4/sim/simulator.hpp"
#include "vm/drivers.hpp"
#include "vm/identity.hpp"
#include "vm/verifier.hpp"

namespace robosync::tool {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::uint64_t kLongestUs = std::uint64_t{24} * 3600 * 1'000'000;
// An event recorded later than replayed by more than this is a different event. One servo frame: no movement is shorter.
constexpr std::uint64_t kMostLateUs = 20'000;
constexpr int kMostAttempts = 16;  // to find when readings came

// A variable begins with a value from before the program: a KEPT one, or one that an upload carried over.
bool is_beginning(const Json& event) {
  return event["event"] == "set" && event.value("step", Json(nullptr)) == 0;
}

// Excludes what is fed to the program and what only depends on the board.
bool is_compared(std::string_view kind) {
  constexpr std::string_view kOthers[] = {"activated", "input",   "stale",  "fault",
                                          "deadline",  "lowered", "silent", "answers"};
  return std::ranges::find(kOthers, kind) == std::end(kOthers);
}

std::string kind_of(const Json& event) {
  return event["event"].get<std::string>();
}

std::uint64_t time_of(const Json& event) {
  return event["t_us"].get<std::uint64_t>();
}

// The record at `index` of a section, in the bytes behind the image.
template <typename Record, typename How>
void change(std::vector<std::byte>& bytes, std::span<const Record> section, std::size_t index,
            const How& how) {
  const auto* const at = reinterpret_cast<const std::byte*>(&section[index]);
  std::byte* const to = bytes.data() + (at - bytes.data());
  Record record;
  std::memcpy(&record, to, sizeof record);
  how(record);
  std::memcpy(to, &record, sizeof record);
}

// The program with all sensors fed, so that it needs neither drivers nor algorithms. A damaged image is returned unchanged.
std::vector<std::byte> with_fed_sensors(std::vector<std::byte> bytes) {
  vm::Image image;
  if (!vm::view_image(bytes, image) || !vm::is_named(bytes, {})) return bytes;
  for (std::size_t i = 0; i < image.sensors.size(); ++i)
    change(bytes, image.sensors, i, [](vm::Sensor& sensor) {
      if (vm::is_served(sensor.driver)) return;
      sensor.driver = vm::DriverId::virtual_sensor;
      sensor.period_ms = 0;
      sensor.first_input = 0;
      sensor.room = 0;
    });
  vm::seal(bytes);
  return bytes;
}

// Channels pass every reading unchanged, and only those that became silent in the recording can become stale.
std::vector<std::byte> with_plain_channels(const Program& program,
                                           const std::set<std::uint8_t>& silent) {
  std::vector<std::byte> bytes(program.bytes().begin(), program.bytes().end());
  vm::Image image;
  if (!vm::view_image(bytes, image)) return bytes;
  for (std::size_t i = 0; i < image.channels.size(); ++i) {
    change(bytes, image.channels, i, [](vm::Channel& channel) { channel.change = 0; });
    if (!silent.contains(static_cast<std::uint8_t>(i)))
      change(bytes, image.channels, i, [](vm::Channel& channel) { channel.stale_ms = 0; });
  }
  vm::seal(bytes);
  return bytes;
}

double thousandths_of(const Json& number) {
  return std::round(number.get<double>() * vm::kScale);
}

// A reading as in the trace: a label, or a number in the canonical unit.
vm::Value value_of(const vm::Image& image, std::uint8_t channel, const Json& value) {
  if (value.is_string()) return parse_reading(image, channel, value.get<std::string>());
  if (!value.is_number()) throw std::invalid_argument("its value is not a number");
  const double thousandths = thousandths_of(value);
  if (std::abs(thousandths) > vm::kValueMax) throw std::invalid_argument("its value is too large");
  return static_cast<vm::Value>(thousandths);
}

// A variable's value as in the trace; nothing if it is not one of its values.
std::optional<vm::Value> value_of(const vm::Image& image, const vm::Variable& variable,
                                  const Json& value) {
  if (value.is_number())
    return static_cast<vm::Value>(
        std::clamp<double>(thousandths_of(value), variable.min, variable.max));
  for (unsigned label = 0; label < variable.label_count; ++label)
    if (value == image.string(image.labels[variable.first_label + label]))
      return static_cast<vm::Value>(label) * vm::kScale;
  return std::nullopt;
}

// An image of `rsc run` has the KEPT numbers that the run began with, as the robot has those of its store: what the program
// declares does not count.
void begin_as_kept(std::vector<std::byte>& bytes, const vm::Image& image,
                   std::span<const std::byte> recorded) {
  vm::Image before;
  if (!vm::verify(recorded, vm::Limits{}, before).ok()) return;
  const auto is_kept = [](const vm::Variable& one) { return one.kind == vm::VariableKind::kept; };
  for (const vm::Variable& old : before.variables)
    for (std::size_t i = 0; i < image.variables.size(); ++i)
      if (is_kept(old) && is_kept(image.variables[i]) &&
          image.string(image.variables[i].name) == before.string(old.name))
        change(bytes, image.variables, i, [&old](vm::Variable& variable) {
          if (variable.dimension == old.dimension)
            variable.initial = std::clamp(old.initial, variable.min, variable.max);
        });
}

// The program with the values that its variables began with in the recording. It may be another one, which lacks some.
std::vector<std::byte> with_beginnings(std::vector<std::byte> bytes,
                                       const RecordedProgram& recorded) {
  vm::Image image;
  if (!vm::view_image(bytes, image)) return bytes;
  begin_as_kept(bytes, image, recorded.image);
  for (const auto& [line, event] : recorded.events) {
    if (!is_beginning(event)) continue;
    for (std::size_t i = 0; i < image.variables.size(); ++i) {
      if (image.string(image.variables[i].name) != event.value("variable", "")) continue;
      const auto value = value_of(image, image.variables[i], event.value("value", Json(nullptr)));
      if (value)
        change(bytes, image.variables, i,
               [&value](vm::Variable& variable) { variable.initial = *value; });
    }
  }
  vm::seal(bytes);
  return bytes;
}

struct Told {
  std::uint64_t at_us = 0;
  std::uint64_t step = 0;
  std::uint8_t channel = 0;
  std::optional<vm::Value> value;  // nothing: the channel became silent
  bool came_earlier = false;       // than the step that tells it
};
using Readings = std::vector<Told>;  // in their order

std::uint64_t step_of(const Json& event) {
  const auto step = event.find("step");
  return step != event.end() && step->is_number_unsigned() ? step->get<std::uint64_t>() : 0;
}

// By name, whatever measures it.
std::uint8_t channel_of(const vm::Image& image, const Json& event) {
  const std::string sensor = event.value("sensor", ""), channel = event.value("channel", "");
  for (std::size_t i = 0; i < image.channels.size(); ++i)
    if (image.string(image.channels[i].name) == channel &&
        image.string(image.sensors[image.channels[i].sensor].name) == sensor)
      return static_cast<std::uint8_t>(i);
  throw std::invalid_argument(fmt::format("it has no channel {}.{}", sensor, channel));
}

Readings readings_of(const RecordedProgram& recorded, const vm::Image& image,
                     const std::string& file) {
  Readings readings;
  for (const auto& [line, event] : recorded.events) {
    const std::string kind = kind_of(event);
    if (kind != "input" && kind != "stale") continue;
    try {
      Told told{time_of(event), step_of(event), channel_of(image, event), std::nullopt, false};
      if (kind == "input")
        told.value = value_of(image, told.channel, event.value("value", Json(nullptr)));
      readings.push_back(told);
    } catch (const std::exception& error) {
      throw Failure(Exit::program, fmt::format("{}:{}: this reading does not fit the program: {}",
                                               file, line, error.what()));
    }
  }
  return readings;
}

std::set<std::uint8_t> silent_ones(const Readings& readings) {
  std::set<std::uint8_t> silent;
  for (const Told& told : readings)
    if (!told.value) silent.insert(told.channel);
  return silent;
}

// Feeds the recording to a simulated robot.
class Feeder {
public:
  Feeder(sim::Simulator& simulator, const RecordedProgram& recorded, const vm::Image& image)
      : simulator_(simulator), image_(image), end_us_(time_of(recorded.events.back().event)) {
    for (const RecordedEvent& one : recorded.events)
      if (is_of_step(kind_of(one.event)) && !is_beginning(one.event))
        first_step_.try_emplace(time_of(one.event), step_of(one.event));
  }

  void run(const Readings& readings, const std::set<std::uint8_t>& silent) {
    for (std::size_t i = 0; i < readings.size(); ++i) {
      const Told& told = readings[i];
      // An earlier step in this millisecond did not have this reading, nor others of the same step.
      const bool is_first_of_step = i == 0 || readings[i - 1].step != told.step;
      if (is_first_of_step && !told.came_earlier && first_step_.at(told.at_us) < told.step)
        simulator_.run_until(told.at_us);
      if (!told.value) continue;
      simulator_.feed(told.at_us, told.channel, *told.value);
      if (silent.contains(told.channel)) repeat(told, next_of(readings, i));
    }
    simulator_.run_until(end_us_);
  }

private:
  // Events that the board stamps with the time of a step; other events have their own times.
  static bool is_of_step(std::string_view kind) {
    constexpr std::string_view kOfStep[] = {"input",     "stale",   "set",        "fire",
                                            "win",       "lose",    "go_on",      "wait",
                                            "interrupt", "overrun", "zero_divide"};
    return std::ranges::find(kOfStep, kind) != std::end(kOfStep);
  }

  static const Told* next_of(const Readings& readings, std::size_t i) {
    for (std::size_t next = i + 1; next < readings.size(); ++next)
      if (readings[next].channel == readings[i].channel) return &readings[next];
    return nullptr;
  }

  // A channel that can become silent gets its value again until then; it becomes silent `life` after the last one
  // (layers/mailbox.hpp).
  void repeat(const Told& told, const Told* next) {
    const std::uint64_t life_us = (image_.channels[told.channel].stale_ms + 1U) * kMicroseconds;
    const std::uint64_t again_us = std::max(life_us / 2, kMicroseconds);
    const std::uint64_t next_us = next == nullptr ? end_us_ : next->at_us;
    const bool falls_silent = next != nullptr && !next->value;
    std::uint64_t until_us = next_us;
    if (falls_silent) until_us = next_us > life_us ? next_us - life_us : 0;
    for (std::uint64_t at = told.at_us + again_us; at < until_us; at += again_us)
      simulator_.feed(at, told.channel, *told.value);
    if (falls_silent && until_us > told.at_us) simulator_.feed(until_us, told.channel, *told.value);
  }

  sim::Simulator& simulator_;
  const vm::Image& image_;
  std::uint64_t end_us_;
  std::map<std::uint64_t, std::uint64_t> first_step_;  // by time
};

// Whether the lines of rules are compared: two programs that decide the same may differ in them.
enum class Lines : std::uint8_t { compared, of_another };

// A rule outside a BEHAVIOR is named by its line.
void leave_lines_out(Json& event) {
  constexpr std::string_view kByItsLine = "the rule at ";
  event.erase("line");
  for (const char* const key : {"by", "behavior"})
    if (const auto name = event.find(key); name != event.end() && name->is_string() &&
                                           name->get<std::string>().starts_with(kByItsLine))
      *name = kByItsLine;
}

// Step numbers are not compared, because a recording leaves out steps without news. Comparison checks the times. The name of a
// SAFETY rule is known with its source only.
bool same(Json a, Json b, Lines lines) {
  for (Json* const event : {&a, &b}) {
    for (const char* const key : {"step", "t_us", "safety"})
      event->erase(key);
    if (lines == Lines::of_another) leave_lines_out(*event);
  }
  return a == b;
}

// The subject of an event: an actuator, a variable or a rule; messages share one subject.
Json subject_of(const Json& event) {
  for (const char* const key : {"actuator", "variable", "rule"})
    if (const auto found = event.find(key); found != event.end()) return {{key, *found}};
  return nullptr;
}

bool is_of_safety(const Json& event) {
  return kind_of(event) == "trip" || kind_of(event) == "resume";
}

std::uint64_t apart(std::uint64_t a, std::uint64_t b) {
  return a > b ? a - b : b - a;
}

// What the replay decides.
// NOLINTNEXTLINE(bugprone-exception-escape): JSON ends itself with memory of its own
struct Decided {
  Json line;
  link::Event event;
};

// `own` with the durations that were measured in the recording; nothing if one differs by more than `most_us`.
std::optional<Json> with_times_of(const Json& recorded, const Decided& own, const TraceNames& names,
                                  std::uint64_t most_us) {
  if (kind_of(recorded) != kind_of(own.line)) return std::nullopt;
  link::Event event = own.event;
  for (const auto& [value, place] : EventReader(own.event, names).durations()) {
    Json measured = recorded.value("value", Json(nullptr));
    if (const auto all = recorded.find("values"); all != recorded.end() && place < all->size())
      measured = (*all)[place];
    if (!measured.is_number()) return std::nullopt;
    const double apart_ms = thousandths_of(measured) - event.values[value];
    if (std::abs(apart_ms) * kMicroseconds > static_cast<double>(most_us)) return std::nullopt;
    event.values[value] += static_cast<std::int32_t>(apart_ms);
  }
  return Json::parse(trace_json(event, names));
}

// Within a millisecond, events are ordered only by their causes: a finished command and a step with a reading may come in either
// order. So each millisecond is compared as a whole. On a board a thread may have to wait for the processor, here none does: a
// recorded event may come a little later than here, and after what a reading caused meanwhile, but never before an earlier event
// of the same subject. The step that tells a reading may be late in the same way, and here the reading comes with that step. But
// SAFETY sees a reading when it comes: so what SAFETY does may be recorded a little earlier than here. What a TIMER measured may
// differ by as much as the events that it measured were late.
struct Millisecond {
  std::vector<const RecordedEvent*> recorded;
  std::vector<const Decided*> replayed;
};

class Comparison {
public:
  Comparison(Lines lines, const TraceNames& names, Replayed& result)
      : lines_(lines), names_(names), result_(result) {}

  // Call in order of time. False: there is a difference.
  [[nodiscard]] bool see(std::uint64_t at_us, const Millisecond& both) {
    if (!await(at_us)) return false;
    for (const Decided* const one : both.replayed)
      if (!was_early(*one)) open_.push_back(one);
    return std::ranges::all_of(both.recorded,
                               [this](const RecordedEvent* one) { return find(*one); });
  }

  // True if no event is overdue at this time; events of the last milliseconds may still be recorded, or replayed.
  [[nodiscard]] bool await(std::uint64_t at_us) {
    const auto is_overdue = [&](const Json& event) { return time_of(event) + kMostLateUs < at_us; };
    if (!early_.empty() && is_overdue(early_.front()->event))
      return differs(early_.front(), nullptr);
    if (!open_.empty() && is_overdue(open_.front()->line)) return differs(nullptr, open_.front());
    return true;
  }

  // The first time at which SAFETY did something in the replay only.
  [[nodiscard]] std::optional<std::uint64_t> safety_alone_us() const {
    for (const Decided* const one : open_)
      if (is_of_safety(one->line)) return time_of(one->line);
    return std::nullopt;
  }

private:
  bool differs(const RecordedEvent* recorded, const Decided* replayed) {
    result_.difference = Difference{recorded == nullptr ? 0 : recorded->line,
                                    recorded == nullptr ? "" : recorded->event.dump(),
                                    replayed == nullptr ? "" : replayed->line.dump()};
    return false;
  }

  [[nodiscard]] bool is_same(const Json& recorded, const Decided& own) const {
    return same(recorded, own.line, lines_);
  }
  [[nodiscard]] bool is_same_but_for_times(const Json& recorded, const Decided& own) const {
    const std::uint64_t most_us =
        std::max(result_.latest_us, apart(time_of(recorded), time_of(own.line)));
    const auto as_measured = with_times_of(recorded, own, names_, std::min(most_us, kMostLateUs));
    return as_measured && same(recorded, *as_measured, lines_);
  }
  [[nodiscard]] const Decided* find_open(const Json& recorded) const {
    for (const Decided* const own : open_)
      if (is_same(recorded, *own)) return own;
    for (const Decided* const own : open_)
      if (is_same_but_for_times(recorded, *own)) return own;
    return nullptr;
  }

  // The first open event that comes before `found`: of its subject, and at an earlier time. If nothing was found, it is any.
  [[nodiscard]] const Decided* before(const Decided* found) const {
    for (const Decided* const other : open_) {
      if (other == found) return nullptr;
      if (found == nullptr || (time_of(other->line) < time_of(found->line) &&
                               subject_of(other->line) == subject_of(found->line)))
        return other;
    }
    return nullptr;
  }

  [[nodiscard]] bool find(const RecordedEvent& one) {
    const Decided* const found = find_open(one.event);
    if (found == nullptr && may_be_early(one.event)) {
      early_.push_back(&one);
      return true;
    }
    const Decided* const earlier = before(found);
    if (found == nullptr || earlier != nullptr) return differs(&one, earlier);
    count(one.event, time_of(found->line));
    std::erase(open_, found);
    return true;
  }

  // With a rule that trips or lets go comes what that does.
  [[nodiscard]] bool may_be_early(const Json& event) const {
    return is_of_safety(event) || std::ranges::any_of(early_, [&](const RecordedEvent* other) {
             return is_of_safety(other->event) && time_of(other->event) == time_of(event);
           });
  }

  // Of one subject, early events come in their order.
  [[nodiscard]] bool was_early(const Decided& own) {
    for (const RecordedEvent* const one : early_) {
      if (subject_of(one->event) != subject_of(own.line)) continue;
      if (!is_same(one->event, own) && !is_same_but_for_times(one->event, own)) return false;
      count(one->event, time_of(own.line));
      std::erase(early_, one);
      return true;
    }
    return false;
  }

  void count(const Json& recorded, std::uint64_t replayed_us) {
    const std::uint64_t at_us = time_of(recorded);
    const std::uint64_t apart_us = apart(at_us, replayed_us);
    ++result_.events;
    result_.commands += kind_of(recorded) == "command" ? 1 : 0;
    if (at_us < replayed_us) {
      ++result_.early;
      result_.earliest_us = std::max(result_.earliest_us, apart_us);
    } else if (at_us > replayed_us) {
      ++result_.late;
      result_.latest_us = std::max(result_.latest_us, apart_us);
    }
  }

  Lines lines_;
  const TraceNames& names_;
  Replayed& result_;
  std::vector<const Decided*> open_;         // replayed, but not yet found in the recording
  std::vector<const RecordedEvent*> early_;  // recorded, but not yet replayed
};

struct Attempt {
  Replayed result;
  std::optional<std::uint64_t> safety_alone_us;
};

Attempt compare(const std::vector<RecordedEvent>& recorded, const std::vector<Decided>& replayed,
                Lines lines, const TraceNames& names) {
  std::map<std::uint64_t, Millisecond> time;
  for (const RecordedEvent& one : recorded)
    if (is_compared(kind_of(one.event)) && !is_beginning(one.event))
      time[time_of(one.event)].recorded.push_back(&one);
  for (const Decided& one : replayed)
    time[time_of(one.line)].replayed.push_back(&one);
  Attempt attempt;
  attempt.result.until_us = time_of(recorded.back().event);
  Comparison comparison(lines, names, attempt.result);
  const bool is_equal = std::ranges::all_of(
      time, [&](const auto& both) { return comparison.see(both.first, both.second); });
  if (is_equal) (void)comparison.await(attempt.result.until_us);
  attempt.safety_alone_us = comparison.safety_alone_us();
  return attempt;
}

std::uint32_t seed_of(const RecordedProgram& recorded) {
  const Json seed = recorded.events.front().event.value("seed", Json(nullptr));
  return seed.is_number_integer() ? static_cast<std::uint32_t>(seed.get<std::int64_t>()) : 0;
}

// Empty if the recorded image is of another version of RoboSync, whose channels are not known.
std::vector<std::string> unrecorded(const RecordedProgram& recorded, const vm::Image& image) {
  vm::Image before;
  std::vector<std::string> names;
  if (!vm::verify(recorded.image, vm::Limits{}, before).ok()) return names;
  const auto name = [](const vm::Image& of, const vm::Channel& channel) {
    return fmt::format("{}.{}", of.string(of.sensors[channel.sensor].name),
                       of.string(channel.name));
  };
  for (const vm::Channel& channel : image.channels) {
    const std::string wanted = name(image, channel);
    const auto is_it = [&](const vm::Channel& other) { return name(before, other) == wanted; };
    if (std::ranges::none_of(before.channels, is_it)) names.push_back(wanted);
  }
  return names;
}

// SAFETY did something at this time in the replay only. Perhaps it had already seen the readings of the next, late steps on the
// board. False: there are none.
bool bring_forward(Readings& readings, std::uint64_t to_us) {
  bool found = false;
  for (Told& told : readings) {
    if (told.at_us <= to_us || told.at_us > to_us + kMostLateUs) continue;
    told.at_us = to_us;
    told.came_earlier = found = true;
  }
  return found;
}

template <typename Try>
Replayed best_of(const Try& attempt, Readings& readings) {
  Attempt best = attempt();
  Attempt last = best;
  for (int i = 1; i < kMostAttempts && last.result.difference && last.safety_alone_us &&
                  bring_forward(readings, *last.safety_alone_us);
       ++i) {
    last = attempt();
    if (!last.result.difference || last.result.events > best.result.events) best = last;
  }
  return best.result;
}

}  // namespace

Replayed replay(const RecordedProgram& recorded, const std::string& file,
                std::span<const std::byte> in_its_place) {
  const std::string name = fmt::format("{}:{}: the program that starts here", file, recorded.line);
  if (time_of(recorded.events.back().event) > kLongestUs)
    throw Failure(Exit::program, name + " ran for longer than a day, which is too long to replay");
  const bool is_other = !in_its_place.empty();
  const Program program(
      with_fed_sensors(is_other ? std::vector(in_its_place.begin(), in_its_place.end())
                                : recorded.image),
      name);
  const vm::Image& image = program.image();
  Readings readings = readings_of(recorded, image, file);
  const TraceNames names{&image, {}, nullptr};
  const auto attempt = [&] {
    std::vector<Decided> replayed;
    const auto take = [&](const link::Event& event) {
      Json line = Json::parse(trace_json(event, names));
      if (is_compared(kind_of(line))) replayed.push_back({std::move(line), event});
    };
    const std::set<std::uint8_t> silent = silent_ones(readings);
    const std::vector<std::byte> bytes =
        with_beginnings(with_plain_channels(program, silent), recorded);
    sim::Simulator simulator(bytes, take, program.board(), seed_of(recorded));
    if (!simulator.verdict().ok())
      throw Failure(Exit::program, name + " does not run on this computer");
    Feeder(simulator, recorded, image).run(readings, silent);
    return compare(recorded.events, replayed, is_other ? Lines::of_another : Lines::compared,
                   names);
  };
  Replayed result = best_of(attempt, readings);
  if (is_other) result.unrecorded = unrecorded(recorded, image);
  return result;
}

}  // namespace robosync::tool
