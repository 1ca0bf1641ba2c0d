// The text is not trusted. Promises that a wrong scenario gets one message with file
// and line, and that a valid one has its stimuli in order of time.
#include "rsc/trace/scenario.hpp"

#include <algorithm>
#include <array>
#include <filesystem>
#include <iostream>
#include <set>
#include <stdexcept>
#include <string_view>

#include <fmt/format.h>

#include "compiler/config/json_reader.hpp"
#include "compiler/source/ascii.hpp"
#include "compiler/source/sorting.hpp"
#include "rsc/failure.hpp"
#include "rsc/files.hpp"
#include "rsc/quantity.hpp"
#include "rsc/trace/channels.hpp"
#include "rsc/trace/csv.hpp"
#include "rsc/trace/sound.hpp"

namespace robosync::tool {
namespace json = compiler::json;
using compiler::Span;

namespace {

constexpr std::uint64_t kRampPeriodUs = 50'000;  // for a sensor without its own period
constexpr std::size_t kMaxStimuli = 1'000'000;

// Where other keys are often written, in stimuli that have these.
struct OtherKey {
  std::string_view word, key;
};
constexpr std::array kOtherKeys = {OtherKey{"time", "at"}, OtherKey{"value", "ramp"}};

std::uint64_t microseconds(std::string_view text) {
  return static_cast<std::uint64_t>(parse_duration(text).count()) * 1000;
}

class ScenarioReader {
public:
  ScenarioReader(const std::string& file, const Program& program)
      : file_(file), program_(program), image_(program.image()) {
    sources_.add(file, read_text(file));
  }

  Scenario read();

private:
  std::size_t line_of(Span span) const { return sources_.file(span.file).line_of(span.begin); }

  [[noreturn]] void fail(Span span, std::string_view message) const {
    throw Failure(Exit::program, fmt::format("{}:{}: {}", file_, line_of(span), message));
  }

  // Reports an error inside `body` as an error in this value.
  template <typename Body>
  auto in(const json::Value& value, Body body) const {
    try {
      return body();
    } catch (const std::invalid_argument& error) {
      fail(value.span, error.what());
    }
  }

  // If `read` cannot open the file, the error is reported at this value. Errors inside the file have
  // their own place.
  template <typename Read>
  auto named_by(const json::Value& value, Read read) const {
    try {
      return read();
    } catch (const Failure& error) {
      if (error.exit() != Exit::outside) throw;
      throw Failure(Exit::outside,
                    fmt::format("{}:{}: {}", file_, line_of(value.span), error.what()));
    }
  }

  // In plain words, as for robot.json, on one line.
  [[noreturn]] void fail_as(const compiler::Diagnostic& mistake) const {
    std::string message = mistake.message;
    Span place;
    for (const compiler::Label& label : mistake.labels) {
      if (label.primary) place = label.span;
      if (label.text.empty()) continue;
      const std::string line = label.primary ? "" : fmt::format("line {}: ", line_of(label.span));
      message += fmt::format("; {}{}", line, label.text);
    }
    for (const std::string& help : mistake.help)
      message += "; " + help;
    fail(place, message);
  }

  json::Value parse() const {
    compiler::Diagnostics diagnostics;
    std::optional<json::Value> root = json::read(sources_, 0, diagnostics);
    if (!root) fail_as(diagnostics.all().front());
    return std::move(*root);
  }

  void check_keys(const json::Value& object, const std::vector<std::string>& known) const {
    std::set<std::string_view> given;
    for (const json::Member& member : object.members) {
      if (std::ranges::find(known, member.key) == known.end())
        fail(member.key_span, fmt::format("there is no key `{}` here{}", member.key,
                                          instead_of_key(member.key, known)));
      if (!given.insert(member.key).second)
        fail(member.key_span, fmt::format("the key `{}` is given twice", member.key));
    }
  }

  static std::string instead_of_key(std::string_view key, const std::vector<std::string>& known) {
    for (const OtherKey& other : kOtherKeys)
      if (other.word == key && std::ranges::find(known, other.key) != known.end())
        return fmt::format("; did you mean `{}`?", other.key);
    return instead_of(key, known);
  }

  std::uint64_t time(const json::Value& value) const {
    if (value.kind != json::Kind::string)
      fail(value.span, "a time is a string with a unit, like \"1.5s\"");
    return in(value, [&] { return microseconds(value.text); });
  }

  // A bare number is only for channels without a unit; others take a number with a unit, or one of
  // their words.
  vm::Value reading(const json::Value& value, std::uint8_t channel) const {
    const bool words = image_.channels[channel].label_count > 0;
    std::string_view text = value.text;
    if (value.kind == json::Kind::boolean && words)
      text = value.truth ? "true" : "false";
    else
      check_reading(value);
    return in(value,
              [&] { return parse_reading(image_, channel, text, unit_of(program_, channel)); });
  }

  void check_reading(const json::Value& value) const {
    if (value.kind != json::Kind::string && value.kind != json::Kind::number)
      fail(value.span,
           "a reading is a number, a string with a unit like \"20cm\", or a word of the channel");
  }

  // For the program it has no effect; but a unit that its channel does not have is a mistake.
  void check_unread(const json::Value& value, const compiler::Unit* unit) const {
    if (unit == nullptr || unit->spelling.empty()) return;  // words, or none
    check_reading(value);
    in(value, [&] { return parse_quantity(value.text, unit->dimension, unit->spelling); });
  }

  const json::Value& need(const json::Value& object, const char* key) const {
    const json::Value* const value = json::find(object, key);
    if (value == nullptr) fail(object.span, fmt::format("this stimulus has no `{}`", key));
    return *value;
  }

  const json::Value& need_string(const json::Value& object, const char* key) const {
    const json::Value& value = need(object, key);
    if (value.kind != json::Kind::string)
      fail(value.span, fmt::format("`{}` is not a string", key));
    return value;
  }

  // With a note if the program does not read it.
  FoundChannel channel_of(const json::Value& stimulus) {
    const json::Value& sensor = need_string(stimulus, "sensor");
    const bool named = json::find(stimulus, "channel") != nullptr;
    const json::Value& last = named ? need_string(stimulus, "channel") : sensor;
    const std::string_view channel = named ? last.text : std::string_view();
    const FoundChannel found =
        in(last, [&] { return find_read_channel(program_, sensor.text, channel); });
    if (!found.read)
      note(file_, line_of(last.span),
           fmt::format("{}{}{}", sensor.text, named ? " " : "", channel));
    return found;
  }

  // Once for each channel.
  void note(std::string_view file, std::size_t line, const std::string& channel) {
    if (!unread_.insert(channel).second) return;
    scenario_.notes.push_back(
        fmt::format("{}:{}: note: the program does not read {}, so what the scenario says about it "
                    "has no effect",
                    file, line, channel));
  }

  void read_stimuli(const json::Value& stimuli) {
    if (stimuli.kind != json::Kind::array) fail(stimuli.span, "`stimuli` is not an array");
    for (const json::Value& stimulus : stimuli.items) {
      stimulus_ = stimulus.span;
      if (stimulus.kind != json::Kind::object) fail(stimulus.span, "a stimulus is an object");
      read_stimulus(stimulus);
    }
  }

  void read_stimulus(const json::Value& stimulus) {
    const auto has = [&](const char* key) { return json::find(stimulus, key) != nullptr; };
    if (has("csv")) {
      check_keys(stimulus, {"csv", "at", "sensor"});
      read_recording(stimulus);
    } else if (has("sound")) {
      check_keys(stimulus, {"sound", "at", "sensor"});
      read_sound(stimulus);
    } else if (has("ramp") || has("from") || has("to")) {
      check_keys(stimulus, {"from", "to", "sensor", "channel", "ramp"});
      read_ramp(stimulus);
    } else {
      check_keys(stimulus, {"at", "sensor", "channel", "value"});
      read_reading(stimulus);
    }
  }

  void read_reading(const json::Value& stimulus) {
    const FoundChannel channel = channel_of(stimulus);
    const std::uint64_t at = time(need(stimulus, "at"));
    const json::Value& value = need(stimulus, "value");
    if (channel.read)
      add(at, *channel.read, reading(value, *channel.read));
    else
      check_unread(value, channel.unit);
  }

  void read_ramp(const json::Value& stimulus) {
    const FoundChannel channel = channel_of(stimulus);
    const json::Value& end = need(stimulus, "to");
    const json::Value& ramp = need(stimulus, "ramp");
    const std::uint64_t from = time(need(stimulus, "from"));
    const std::uint64_t to = time(end);
    if (to <= from) fail(end.span, "the ramp ends before it starts");
    if (ramp.items.size() != 2) fail(ramp.span, "`ramp` is [first reading, last reading]");
    if (!channel.read) {
      for (const json::Value& value : ramp.items)
        check_unread(value, channel.unit);
      return;
    }
    const vm::Value first = reading(ramp.items[0], *channel.read);
    const vm::Value last = reading(ramp.items[1], *channel.read);
    const vm::Channel& record = image_.channels[*channel.read];
    if (first != last && record.label_count > 0)
      fail(ramp.span, fmt::format("{} has words, and nothing lies between two words: "
                                  "write a stimulus with `at` and `value` for each",
                                  image_.string(record.name)));
    add_ramp(from, to, *channel.read, first, last);
  }

  // ---- recordings of sound

  std::uint64_t begin_of(const json::Value& recording) const {
    const json::Value* const at = json::find(recording, "at");
    return at == nullptr ? 0 : time(*at);
  }

  std::string beside(std::string_view name) const {
    return (std::filesystem::path(file_).parent_path() / name).string();
  }

  // A sensor that is sampled measures its last value on and on, a microphone only as long as the recording.
  void end_at(std::uint64_t at, std::uint8_t channel) {
    if (!policy::is_fed(image_.sensors[image_.channels[channel].sensor]))
      scenario_.stimuli.push_back({at, channel, vm::kUnknown});
  }

  // A microphone whose channels are written out need not have a spectrum.
  bool knows(std::string_view sensor, const char* channel) const {
    const std::string name = fmt::format("{}.{}", sensor, channel);
    return std::ranges::any_of(program_.origin().units.channels, [&](const auto& known) {
      return compiler::ascii::same(known.first, name);
    });
  }

  // The channels of a microphone that the program, or an algorithm that it uses, reads.
  void read_sound(const json::Value& stimulus) {
    const json::Value& sensor = need_string(stimulus, "sensor");
    const json::Value& sound = need_string(stimulus, "sound");
    const std::uint64_t begin = begin_of(stimulus);
    const std::vector<SoundBlock> blocks =
        named_by(sound, [&] { return hear_file(beside(sound.text)); });
    bool is_read = false;
    for (std::size_t part = 0; part < kSoundChannels.size(); ++part) {
      if (part >= vm::kFirstOfSpectrum && !knows(sensor.text, kSoundChannels[part])) continue;
      const auto channel = in(sensor, [&] {
        return find_read_channel(program_, sensor.text, kSoundChannels[part]).read;
      });
      std::uint64_t at = begin;
      for (const SoundBlock& block : blocks)
        if (channel) add(at += drivers::kEarPeriodMs * std::uint64_t{1000}, *channel, block[part]);
      if (channel) end_at(at + drivers::kEarPeriodMs * std::uint64_t{1000}, *channel);
      is_read = is_read || channel;
    }
    if (!is_read) note(file_, line_of(sensor.span), sensor.text);
  }

  // ---- recordings in CSV

  struct Column {
    std::optional<std::uint8_t> channel;  // none: the times, or not read by the program
    std::string unit;                     // of bare numbers
  };

  void read_recording(const json::Value& stimulus) {
    const json::Value& name = need_string(stimulus, "csv");
    const bool has_sensor = json::find(stimulus, "sensor") != nullptr;
    const std::string sensor = has_sensor ? need_string(stimulus, "sensor").text : "";
    const std::uint64_t begin = begin_of(stimulus);
    const std::string file = beside(name.text);
    const CsvTable table = named_by(name, [&] { return read_csv(file); });
    std::size_t time_column = table.columns.cells.size();
    const std::vector<Column> columns = read_columns(file, table, sensor, time_column);
    for (const CsvRow& row : table.rows)
      add_row({file, row, columns, time_column}, begin);
    in_recording_ = nullptr;
  }

  [[noreturn]] static void fail_in(const std::string& file, std::size_t line,
                                   std::string_view message) {
    throw Failure(Exit::program, fmt::format("{}:{}: {}", file, line, message));
  }

  // `DISTANCE (cm)`: a name with the unit of its numbers in brackets.
  static std::pair<std::string, std::string> name_and_unit(const std::string& cell) {
    const std::size_t open = cell.find('(');
    if (open == std::string::npos || cell.back() != ')') return {cell, ""};
    const std::size_t end = cell.find_last_not_of(' ', open == 0 ? 0 : open - 1);
    return {cell.substr(0, end + 1), cell.substr(open + 1, cell.size() - open - 2)};
  }

  static bool is_among(const std::vector<Column>& columns, const Column& column) {
    return column.channel &&
           std::ranges::find(columns, column.channel, &Column::channel) != columns.end();
  }

  std::vector<Column> read_columns(const std::string& file, const CsvTable& table,
                                   std::string_view sensor, std::size_t& time_column) {
    std::vector<Column> columns;
    columns.reserve(table.columns.cells.size());
    for (const std::string& cell : table.columns.cells) {
      auto [name, unit] = name_and_unit(cell);
      const bool is_time = compiler::ascii::same(name, "time");
      const Column column =
          is_time ? Column{{}, unit} : read_column(file, table.columns.line, sensor, name, unit);
      if (is_time ? time_column < table.columns.cells.size() : is_among(columns, column))
        scenario_.notes.push_back(
            fmt::format("{}:{}: note: two columns are called `{}`; the last one counts", file,
                        table.columns.line, name));
      if (is_time) time_column = columns.size();
      columns.push_back(column);
    }
    if (time_column == columns.size())
      fail_in(file, table.columns.line, "no column is called `time`, as in `time (s)`");
    return columns;
  }

  Column read_column(const std::string& file, std::size_t line, std::string_view sensor,
                     const std::string& name, const std::string& unit) {
    try {
      const auto channel = sensor.empty() ? find_read_channel(program_, name, "").read
                                          : find_read_channel(program_, sensor, name).read;
      if (!channel) note(file, line, sensor.empty() ? name : fmt::format("{} {}", sensor, name));
      const bool own = unit.empty() && channel;
      return {channel, own ? std::string(unit_of(program_, *channel)) : unit};
    } catch (const std::invalid_argument& error) {
      fail_in(file, line, error.what());
    }
  }

  struct Row {
    const std::string& file;
    const CsvRow& cells;
    const std::vector<Column>& columns;
    std::size_t time_column;
  };

  // A number without a unit has its column's unit.
  static std::string with_unit(const std::string& cell, const std::string& unit) {
    const bool bare = cell.find_first_not_of("0123456789.-+eE") == std::string::npos;
    return bare ? cell + unit : cell;
  }

  // An empty cell is not a reading.
  void add_row(const Row& row, std::uint64_t begin) {
    const std::vector<std::string>& cells = row.cells.cells;
    in_recording_ = &row;
    try {
      const std::string& unit = row.columns[row.time_column].unit;
      const std::uint64_t at_us = begin + microseconds(with_unit(cells[row.time_column], unit));
      for (std::size_t i = 0; i < cells.size(); ++i) {
        const auto channel = row.columns[i].channel;
        if (!channel || cells[i].empty()) continue;
        const bool words = image_.channels[*channel].label_count > 0;
        add(at_us, *channel,
            parse_reading(image_, *channel,
                          words ? cells[i] : with_unit(cells[i], row.columns[i].unit),
                          unit_of(program_, *channel)));
      }
    } catch (const std::invalid_argument& error) {
      fail_in(row.file, row.cells.line, error.what());
    }
  }

  // ---- readings one by one

  // A reading in each period of the sensor, and one at the end.
  void add_ramp(std::uint64_t from, std::uint64_t to, std::uint8_t channel, std::int64_t first,
                std::int64_t last) {
    const std::uint16_t period_ms = image_.sensors[image_.channels[channel].sensor].period_ms;
    const std::uint64_t period = period_ms > 0 ? period_ms * std::uint64_t{1000} : kRampPeriodUs;
    const auto length = static_cast<std::int64_t>(to - from);
    for (std::uint64_t at = from; at < to; at += period) {
      // Milliseconds keep the product of two 32-bit spans inside 64 bits.
      const auto done = static_cast<std::int64_t>(at - from) / 1000;
      add(at, channel, static_cast<vm::Value>(first + (last - first) * done / (length / 1000)));
    }
    add(to, channel, static_cast<vm::Value>(last));
  }

  void add(std::uint64_t at, std::uint8_t channel, vm::Value value) {
    if (scenario_.stimuli.size() == kMaxStimuli) {
      fail(stimulus_, "the scenario has more than a million readings");
    }
    note_range(channel, value);
    scenario_.stimuli.push_back({at, channel, value});
  }

  // Once for each channel.
  void note_range(std::uint8_t channel, vm::Value value) {
    const std::string note = range_note(program_, channel, value);
    if (note.empty() || !out_of_range_.insert(channel).second) return;
    scenario_.notes.push_back(fmt::format(
        "{}:{}: note: {}", in_recording_ == nullptr ? file_ : in_recording_->file,
        in_recording_ == nullptr ? line_of(stimulus_) : in_recording_->cells.line, note));
  }

  const std::string& file_;
  compiler::SourceMap sources_;
  const Program& program_;
  const vm::Image& image_;
  Span stimulus_;                        // the current one
  const Row* in_recording_ = nullptr;    // the current row, while reading one
  std::set<std::uint8_t> out_of_range_;  // channels with a note
  std::set<std::string> unread_;         // channels with a note
  Scenario scenario_;
};

Scenario ScenarioReader::read() {
  const json::Value root = parse();
  if (root.kind != json::Kind::object) fail({}, "a scenario is an object: {\"stimuli\": […]}");
  check_keys(root, {"$schema", "duration", "stimuli"});
  if (const json::Value* const duration = json::find(root, "duration"))
    scenario_.duration_us = time(*duration);
  if (const json::Value* const stimuli = json::find(root, "stimuli")) read_stimuli(*stimuli);
  compiler::sort_stably(scenario_.stimuli, {}, &Stimulus::at_us);
  return std::move(scenario_);
}

}  // namespace

Scenario read_scenario(const std::string& file, const Program& program) {
  return ScenarioReader(file, program).read();
}

void show_notes(const Scenario& scenario) {
  for (const std::string& note : scenario.notes)
    std::cerr << note << '\n';
}

}  // namespace robosync::tool
