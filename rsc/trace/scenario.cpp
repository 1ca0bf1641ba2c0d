// Uses Jansson. The text is not trusted. Promises that a wrong scenario gets one message with file
// and line, and that a valid one has its stimuli in order of time.
#include "rsc/trace/scenario.hpp"

#include <algorithm>
#include <array>
#include <filesystem>
#include <iostream>
#include <memory>
#include <set>
#include <stdexcept>
#include <string_view>

#include <fmt/format.h>
#include <jansson.h>

#include "compiler/diagnostics/nearest.hpp"
#include "compiler/source/ascii.hpp"
#include "compiler/source/sorting.hpp"
#include "compiler/units/units.hpp"
#include "rsc/failure.hpp"
#include "rsc/files.hpp"
#include "rsc/quantity.hpp"
#include "rsc/trace/channels.hpp"
#include "rsc/trace/csv.hpp"
#include "rsc/trace/json_lines.hpp"
#include "rsc/trace/sound.hpp"

namespace robosync::tool {
namespace {

constexpr std::uint64_t kRampPeriodUs = 50'000;  // for a sensor without its own period
constexpr std::size_t kMaxStimuli = 1'000'000;

struct FreeJson {
  void operator()(json_t* value) const { json_decref(value); }
};

std::uint64_t microseconds(std::string_view text) {
  return static_cast<std::uint64_t>(parse_duration(text).count()) * 1000;
}

class ScenarioReader {
public:
  ScenarioReader(const std::string& file, const Program& program)
      : file_(file), text_(read_text(file)), program_(program), image_(program.image()) {}

  Scenario read();

private:
  [[noreturn]] void fail(std::size_t line, std::string_view message) const {
    throw Failure(Exit::program, fmt::format("{}:{}: {}", file_, line, message));
  }

  // The line of a key in the current element, or else of the element.
  std::size_t line_of_key(std::string_view key) const {
    const std::string_view element(text_.data() + element_.begin, element_.end - element_.begin);
    const std::size_t at = element.find(fmt::format("\"{}\"", key));
    return line_of(text_, element_.begin + (at == std::string_view::npos ? 0 : at));
  }

  // Reports an error inside `body` as an error in the value of this key.
  template <typename Body>
  auto at_key(std::string_view key, Body body) const {
    try {
      return body();
    } catch (const std::invalid_argument& error) {
      fail(line_of_key(key), error.what());
    }
  }

  // If `read` cannot open the file, the error is reported at this key. Errors inside the file have
  // their own place.
  template <typename Read>
  auto named_by(std::string_view key, Read read) const {
    try {
      return read();
    } catch (const Failure& error) {
      if (error.exit() != Exit::outside) throw;
      throw Failure(Exit::outside, fmt::format("{}:{}: {}", file_, line_of_key(key), error.what()));
    }
  }

  void check_keys(json_t* object, std::initializer_list<const char*> known) const {
    const std::vector<std::string> names(known.begin(), known.end());
    const char* key = nullptr;
    json_t* value = nullptr;
    json_object_foreach(object, key, value) {
      if (std::ranges::find(names, key) != names.end()) continue;
      const auto near = compiler::nearest(key, names);
      fail(line_of_key(key), fmt::format("there is no key `{}` here{}", key,
                                         near ? fmt::format("; did you mean `{}`?", *near) : ""));
    }
  }

  static std::uint64_t time(json_t* value) {
    if (!json_is_string(value)) {
      throw std::invalid_argument("a time is a string with a unit, like \"1.5s\"");
    }
    return microseconds(json_string_value(value));
  }

  // A bare number is only for channels without a unit; others take a number with a unit, or one of
  // their words.
  vm::Value reading(json_t* value, std::uint8_t channel) const {
    const auto parse = [&](std::string_view text) {
      return parse_reading(image_, channel, text, unit_of(program_, channel));
    };
    if (json_is_string(value)) return parse(json_string_value(value));
    if (json_is_boolean(value) && image_.channels[channel].label_count > 0)
      return parse(json_is_true(value) ? "true" : "false");
    if (json_is_integer(value)) return parse(std::to_string(json_integer_value(value)));
    if (json_is_real(value)) return parse(fmt::format("{:.3f}", json_real_value(value)));
    throw std::invalid_argument(
        "a reading is a number, a string with a unit like \"20cm\", or a word of the channel");
  }

  json_t* need(json_t* object, const char* key) const {
    json_t* const value = json_object_get(object, key);
    if (value == nullptr) {
      fail(line_of(text_, element_.begin), fmt::format("this stimulus has no `{}`", key));
    }
    return value;
  }

  std::string_view need_string(json_t* object, const char* key) const {
    json_t* const value = need(object, key);
    if (!json_is_string(value)) fail(line_of_key(key), fmt::format("`{}` is not a string", key));
    return json_string_value(value);
  }

  // Nothing, with a note, if the program does not read it.
  std::optional<std::uint8_t> channel_of(json_t* stimulus) {
    const std::string_view sensor = need_string(stimulus, "sensor");
    const bool named = json_object_get(stimulus, "channel") != nullptr;
    const std::string_view channel = named ? need_string(stimulus, "channel") : "";
    const char* const key = named ? "channel" : "sensor";
    const auto found = at_key(key, [&] { return find_read_channel(program_, sensor, channel); });
    if (!found)
      note(file_, line_of_key(key), fmt::format("{}{}{}", sensor, named ? " " : "", channel));
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

  void read_stimuli(json_t* stimuli) {
    if (stimuli == nullptr) return;
    if (!json_is_array(stimuli)) fail(line_of_key("stimuli"), "`stimuli` is not an array");
    const std::vector<TextRange> places = array_elements(text_, "stimuli");
    std::size_t index = 0;
    json_t* stimulus = nullptr;
    json_array_foreach(stimuli, index, stimulus) {
      element_ = places.at(index);
      if (!json_is_object(stimulus)) {
        fail(line_of(text_, element_.begin), "a stimulus is an object");
      }
      read_stimulus(stimulus);
    }
  }

  void read_stimulus(json_t* stimulus) {
    if (json_object_get(stimulus, "csv") != nullptr) {
      check_keys(stimulus, {"csv", "at", "sensor"});
      read_recording(stimulus);
    } else if (json_object_get(stimulus, "sound") != nullptr) {
      check_keys(stimulus, {"sound", "at", "sensor"});
      read_sound(stimulus);
    } else if (json_object_get(stimulus, "ramp") != nullptr) {
      check_keys(stimulus, {"from", "to", "sensor", "channel", "ramp"});
      read_ramp(stimulus);
    } else {
      check_keys(stimulus, {"at", "sensor", "channel", "value"});
      read_reading(stimulus);
    }
  }

  void read_reading(json_t* stimulus) {
    const auto channel = channel_of(stimulus);
    json_t* const at = need(stimulus, "at");
    json_t* const value = need(stimulus, "value");
    const std::uint64_t at_us = at_key("at", [&] { return time(at); });
    if (channel) add(at_us, *channel, at_key("value", [&] { return reading(value, *channel); }));
  }

  void read_ramp(json_t* stimulus) {
    const auto channel = channel_of(stimulus);
    json_t* const from_value = need(stimulus, "from");
    json_t* const to_value = need(stimulus, "to");
    json_t* const ramp = need(stimulus, "ramp");
    const std::uint64_t from = at_key("from", [&] { return time(from_value); });
    const std::uint64_t to = at_key("to", [&] { return time(to_value); });
    if (to <= from) fail(line_of_key("to"), "the ramp ends before it starts");
    if (json_array_size(ramp) != 2) {
      fail(line_of_key("ramp"), "`ramp` is [first reading, last reading]");
    }
    if (!channel) return;
    const auto end = [&](std::size_t which) {
      return at_key("ramp", [&] { return reading(json_array_get(ramp, which), *channel); });
    };
    const vm::Value first = end(0), last = end(1);
    if (first != last && image_.channels[*channel].label_count > 0)
      fail(line_of_key("ramp"), fmt::format("{} has words, and nothing lies between two words: "
                                            "write a stimulus with `at` and `value` for each",
                                            image_.string(image_.channels[*channel].name)));
    add_ramp(from, to, *channel, first, last);
  }

  // ---- recordings of sound

  std::uint64_t begin_of(json_t* recording) const {
    json_t* const at = json_object_get(recording, "at");
    return at == nullptr ? 0 : at_key("at", [&] { return time(at); });
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
  void read_sound(json_t* stimulus) {
    const std::string_view sensor = need_string(stimulus, "sensor");
    const std::string file = beside(need_string(stimulus, "sound"));
    const std::uint64_t begin = begin_of(stimulus);
    const std::vector<SoundBlock> blocks = named_by("sound", [&] { return hear_file(file); });
    bool is_read = false;
    for (std::size_t part = 0; part < kSoundChannels.size(); ++part) {
      if (part >= vm::kFirstOfSpectrum && !knows(sensor, kSoundChannels[part])) continue;
      const auto channel = at_key(
          "sensor", [&] { return find_read_channel(program_, sensor, kSoundChannels[part]); });
      std::uint64_t at = begin;
      for (const SoundBlock& block : blocks)
        if (channel) add(at += drivers::kEarPeriodMs * std::uint64_t{1000}, *channel, block[part]);
      if (channel) end_at(at + drivers::kEarPeriodMs * std::uint64_t{1000}, *channel);
      is_read = is_read || channel;
    }
    if (!is_read) note(file_, line_of_key("sensor"), std::string(sensor));
  }

  // ---- recordings in CSV

  struct Column {
    std::optional<std::uint8_t> channel;  // none: the times, or not read by the program
    std::string unit;                     // of bare numbers
  };

  void read_recording(json_t* stimulus) {
    const std::string_view name = need_string(stimulus, "csv");
    const bool has_sensor = json_object_get(stimulus, "sensor") != nullptr;
    const std::string_view sensor = has_sensor ? need_string(stimulus, "sensor") : "";
    const std::uint64_t begin = begin_of(stimulus);
    const std::string file = beside(name);
    const CsvTable table = named_by("csv", [&] { return read_csv(file); });
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
      const auto channel = sensor.empty() ? find_read_channel(program_, name, "")
                                          : find_read_channel(program_, sensor, name);
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
      fail(line_of(text_, element_.begin), "the scenario has more than a million readings");
    }
    const vm::Channel& range = image_.channels[channel];
    if (value < range.min || value > range.max) note_range(channel, value);
    scenario_.stimuli.push_back({at, channel, value});
  }

  // Once for each channel.
  void note_range(std::uint8_t channel, vm::Value value) {
    if (!out_of_range_.insert(channel).second) return;
    const vm::Channel& range = image_.channels[channel];
    const compiler::Unit* const written = compiler::find_unit(unit_of(program_, channel));
    const bool fits = written != nullptr && written->dimension == range.dimension;
    const compiler::Unit& unit = fits ? *written : compiler::canonical_unit(range.dimension);
    const auto text = [&](vm::Value one) { return compiler::format_value(one, unit); };
    scenario_.notes.push_back(fmt::format(
        "{}:{}: note: {} is out of the range of {} {}, {} to {}: the robot reads {}",
        in_recording_ == nullptr ? file_ : in_recording_->file,
        in_recording_ == nullptr ? line_of(text_, element_.begin) : in_recording_->cells.line,
        text(value), image_.string(image_.sensors[range.sensor].name), image_.string(range.name),
        text(range.min), text(range.max), text(std::clamp(value, range.min, range.max))));
  }

  const std::string& file_;
  std::string text_;
  const Program& program_;
  const vm::Image& image_;
  TextRange element_;                    // the current stimulus
  const Row* in_recording_ = nullptr;    // the current row, while reading one
  std::set<std::uint8_t> out_of_range_;  // channels with a note
  std::set<std::string> unread_;         // channels with a note
  Scenario scenario_;
};

Scenario ScenarioReader::read() {
  json_error_t error{};
  const std::unique_ptr<json_t, FreeJson> root(
      json_loadb(text_.data(), text_.size(), JSON_REJECT_DUPLICATES, &error));
  if (!root)
    fail(static_cast<std::size_t>(std::max(error.line, 1)),
         fmt::format("this is not JSON, at column {}: {}", error.column, error.text));
  element_ = {0, text_.size()};
  if (!json_is_object(root.get())) fail(1, "a scenario is an object: {\"stimuli\": […]}");
  check_keys(root.get(), {"$schema", "duration", "stimuli"});
  if (json_t* const duration = json_object_get(root.get(), "duration")) {
    scenario_.duration_us = at_key("duration", [&] { return time(duration); });
  }
  read_stimuli(json_object_get(root.get(), "stimuli"));
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
