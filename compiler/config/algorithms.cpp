#include "compiler/config/algorithms.hpp"

#include <algorithm>
#include <array>
#include <filesystem>
#include <iterator>
#include <system_error>
#include <utility>

#include "compiler/config/entries.hpp"
#include "compiler/config/fields.hpp"
#include "compiler/config/values.hpp"
#include "compiler/diagnostics/nearest.hpp"

namespace robosync::compiler {
namespace {

constexpr std::string_view kWordsKey = "words";
constexpr const char* kElsewhere =
    "`\"on\": \"companion\"` lets a computer beside the robot listen, with its own microphone";

class AlgorithmReader {
public:
  AlgorithmReader(const json::Value& value, const std::string& file,
                  const AlgorithmModules& modules, Robot& robot, Diagnostics& diagnostics)
      : fields_(value, Object::algorithm, diagnostics),
        folder_(std::filesystem::path(file).parent_path()),
        modules_(modules),
        robot_(robot),
        diagnostics_(diagnostics) {}

  bool read() {
    const auto name = read_name(fields_, "an algorithm", diagnostics_);
    if (!name || !read_place()) return false;
    const auto* path = fields_.find("path");
    if (path != nullptr && is_missing(*name, *path)) return true;
    if (path != nullptr ? !load_module(*path) : !find_module()) return false;
    return module_->device.empty() ? add_on_board(*name) : add_on_companion(*name);
  }

private:
  bool add_on_board(const Spelled& name) {
    const SensorConfig* const input = find_input();
    if (input == nullptr || !can_read(*input)) return false;
    SensorConfig sensor;
    sensor.name = name;
    sensor.driver = vm::DriverId::algorithm;
    sensor.period_ms = period(*input);
    sensor.algorithm = {number_,
                        static_cast<std::size_t>(input - robot_.sensors.data()),
                        first_of(*input),
                        module_->inputs.size(),
                        config(*input->channels.front().unit),
                        module_->room,
                        input_span_};
    for (const ModuleOutput& output : module_->outputs) {
      sensor.channels.push_back(channel(name, output));
      sensor.channels.back().stale_ms = stale_as(*input);
    }
    if (is_taught() && !add_taught_words(name, sensor)) return false;
    robot_.sensors.push_back(std::move(sensor));
    return true;
  }

  // To the board it is a fed sensor.
  bool add_on_companion(const Spelled& name) {
    check_device();
    SensorConfig sensor;
    sensor.name = name;
    sensor.driver = vm::DriverId::virtual_sensor;
    const std::uint16_t period = period_in_range(module_->usual_period_ms, name.span);
    sensor.companion = {module_->name, period, config(canonical_unit(vm::Dimension::number))};
    for (const ModuleOutput& output : module_->outputs) {
      sensor.channels.push_back(channel(name, output));
      sensor.channels.back().stale_ms =
          static_cast<std::uint16_t>(std::min(period * kStalePeriods, UINT16_MAX));
    }
    if (is_taught() && !add_taught_words(name, sensor)) return false;
    robot_.sensors.push_back(std::move(sensor));
    return true;
  }

  std::string shown() const { return "`" + module_->name + "`"; }

  // ---- which module

  // Reads `on`, if it is there: where the module runs.
  bool read_place() {
    on_ = fields_.find("on");
    if (on_ == nullptr) return true;
    constexpr std::array<std::string_view, 2> kPlaces = {"board", "companion"};
    const auto place = read_choice(*on_, kPlaces, diagnostics_);
    if (place) wants_companion_ = *place == 1;
    return place.has_value();
  }

  bool runs_where_it_should() {
    const bool on_companion = !module_->device.empty();
    if (!wants_companion_ || *wants_companion_ == on_companion) return true;
    diagnostics_
        .report(Code::E0205, shown() + (on_companion ? " runs only on a companion computer"
                                                     : " runs only on the board"))
        .label(on_->span)
        .helps(on_companion ? "write \"companion\", or remove `on`"
                            : "remove `on`; `rsc companion --list` lists what runs on a companion");
    return false;
  }

  std::string in_folder(const std::string& path) const {
    return (folder_ / path).lexically_normal().string();
  }

  // A missing file is only a warning, so that the rest of the robot can still be checked.
  bool is_missing(const Spelled& name, const json::Value& path) {
    std::error_code error;
    if (path.kind != json::Kind::string || std::filesystem::exists(in_folder(path.text), error))
      return false;
    const std::string file = in_folder(path.text);
    robot_.missing.push_back({name, file, path.span, how_to_make()});
    diagnostics_
        .report(Code::W0214, "there is no file " + file + ": " + name.shown() + " does nothing")
        .label(path.span)
        .helps(robot_.missing.back().help);
    return true;
  }

  // `rsc new --module` adds the CMakeLists.txt that builds the module.
  std::string how_to_make() const {
    std::error_code error;
    if (!std::filesystem::exists(folder_ / "CMakeLists.txt", error))
      return "build it from its C file with a compiler (docs/algorithms.md)";
    return "`cmake -B build && cmake --build build` in the folder of robot.json builds it from its "
           "C file";
  }

  bool load_module(const json::Value& path) {
    if (!read_text(path, diagnostics_)) return false;
    if (wants_companion_.value_or(false)) {
      diagnostics_
          .report(Code::E0205,
                  "a module in a file runs in rsc run and rsc test, not on a companion computer")
          .label(on_->span)
          .label(path.span, "the file", false)
          .helps("remove `on`");
      return false;
    }
    if (const auto* module = fields_.find("module")) {
      diagnostics_.report(Code::E0205, "a module comes from a file or from the firmware, not both")
          .label(module->span)
          .label(path.span, "the file", false)
          .helps("remove one of the two");
      return false;
    }
    const std::string file = in_folder(path.text);
    const ModuleInFile found = modules_.in_file != nullptr
                                   ? modules_.in_file(file)
                                   : ModuleInFile{nullptr, 0, "this tool does not load files"};
    module_ = found.module;
    number_ = found.number;
    if (module_ == nullptr)
      diagnostics_.report(Code::E0210, "the module " + file + " cannot be used: " + found.why_not)
          .label(path.span)
          .helps("`rsc module check " + file + "` examines it");
    return module_ != nullptr;
  }

  template <typename Named>
  static std::vector<std::string> names_of(const Named& list) {
    std::vector<std::string> names;
    names.reserve(list.size());
    for (const auto& entry : list)
      names.push_back(entry.name);
    return names;
  }

  bool find_module() {
    const auto* value = fields_.require("module", "an algorithm");
    if (value == nullptr || !read_text(*value, diagnostics_)) return false;
    const auto& firmware = modules_.firmware;
    const auto found = std::ranges::find(firmware, value->text, &AlgorithmModule::name);
    const auto beside = std::ranges::find(modules_.companion, value->text, &AlgorithmModule::name);
    const bool in_both = found != firmware.end() && beside != modules_.companion.end();
    if (found != firmware.end() && !(in_both && runs_on_companion(*found))) {
      module_ = &*found;
      number_ = static_cast<std::uint8_t>(found - firmware.begin());
    } else if (beside != modules_.companion.end()) {
      module_ = &*beside;
    } else {
      report_unknown_module(*value);
    }
    return module_ != nullptr && runs_where_it_should();
  }

  // A module that both have runs on the board if that has what it reads, unless `on` says where.
  bool runs_on_companion(const AlgorithmModule& on_board) {
    if (wants_companion_) return *wants_companion_;
    const auto* value = fields_.find("input");
    if (value == nullptr || value->kind != json::Kind::string) return true;
    return std::ranges::none_of(robot_.sensors, [&](const SensorConfig& sensor) {
      return same_name(sensor.name.text, value->text) && has_channel(sensor, on_board);
    });
  }

  static bool has_channel(const SensorConfig& sensor, const AlgorithmModule& module) {
    return std::ranges::any_of(sensor.channels, [&](const ChannelConfig& channel) {
      return same_name(channel.name.text, module.inputs.front().name);
    });
  }

  // Suggests the modules of the place that `on` names, or of both places.
  void report_unknown_module(const json::Value& value) {
    std::vector<std::string> known;
    if (!wants_companion_.value_or(false)) known = names_of(modules_.firmware);
    if (wants_companion_.value_or(true))
      std::ranges::copy_if(
          names_of(modules_.companion), std::back_inserter(known),
          [&](const std::string& name) { return std::ranges::find(known, name) == known.end(); });
    const std::string who = !wants_companion_   ? "there is"
                            : *wants_companion_ ? "a companion computer has"
                                                : "the firmware has";
    Diagnostic& d =
        diagnostics_.report(Code::E0209, who + " no algorithm module `" + value.text + "`")
            .label(value.span);
    if (!did_you_mean(d, value.span, value.text, known, "\"") && !known.empty())
      d.helps("modules: " + list_names(known));
  }

  // ---- its input

  const SensorConfig* find_input() {
    const auto* value = fields_.require("input", shown());
    if (value == nullptr || !read_text(*value, diagnostics_)) return nullptr;
    input_span_ = value->span;
    for (const SensorConfig& sensor : robot_.sensors)
      if (same_name(sensor.name.text, value->text)) return usable(sensor);
    if (!robot_.complete) return nullptr;  // the mistake may be in its entry
    std::vector<std::string> known;
    for (const SensorConfig& sensor : robot_.sensors)
      if (!is_algorithm(sensor)) known.push_back(sensor.name.text);
    Diagnostic& d = diagnostics_.report(Code::E0501, "there is no sensor `" + value->text + "`")
                        .label(value->span);
    if (!did_you_mean(d, value->span, value->text, known, "\"") && !known.empty())
      d.helps("sensors: " + list_names(known));
    if (is_taught()) d.helps(kElsewhere);
    return nullptr;
  }

  static bool is_algorithm(const SensorConfig& sensor) {
    return sensor.algorithm || sensor.companion;
  }

  const SensorConfig* usable(const SensorConfig& sensor) {
    if (!is_algorithm(sensor)) return &sensor;
    diagnostics_.report(Code::E0205, "an algorithm cannot read another algorithm")
        .label(input_span_)
        .helps("name the sensor that it reads");
    return nullptr;
  }

  // The module reads channels that follow each other, from the one with the name of its first input on, or else from the first.
  std::size_t first_of(const SensorConfig& sensor) const {
    const auto named = std::ranges::find_if(sensor.channels, [&](const ChannelConfig& channel) {
      return same_name(channel.name.text, module_->inputs.front().name);
    });
    return named == sensor.channels.end()
               ? 0
               : static_cast<std::size_t>(named - sensor.channels.begin());
  }

  bool can_read(const SensorConfig& sensor) {
    const std::size_t needed = module_->inputs.size(), first = first_of(sensor);
    if (is_taught() && !has_channel(sensor, *module_)) {
      diagnostics_
          .report(Code::E0205, shown() + " reads the spectrum of a microphone, but " +
                                   sensor.name.shown() + " has none")
          .label(input_span_)
          .helps(kElsewhere);
      return false;
    }
    if (sensor.channels.size() - first < needed) {
      diagnostics_
          .report(Code::E0205, shown() + " reads " + std::to_string(needed) + " channels, but " +
                                   sensor.name.shown() + " has " +
                                   std::to_string(sensor.channels.size()))
          .label(input_span_)
          .helps("it needs, in this order: " + list_names(names_of(module_->inputs)));
      return false;
    }
    for (std::size_t i = 0; i < needed; ++i)
      if (!can_read(sensor.channels[first + i], module_->inputs[i])) return false;
    return true;
  }

  bool can_read(const ChannelConfig& channel, const ModuleInput& input) {
    const vm::Dimension wanted = input.dimension.value_or(channel.unit->dimension);
    if (channel.labels.empty() && wanted == channel.unit->dimension) return true;
    const std::string what =
        input.dimension ? std::string(dimension_phrase(wanted)) : std::string("numbers");
    const std::string is = channel.labels.empty()
                               ? std::string(dimension_phrase(channel.unit->dimension))
                               : std::string("words");
    diagnostics_
        .report(Code::E0205, shown() + " needs " + what + " as its " + input.name + ", but " +
                                 channel.name.shown() + " gives " + is)
        .label(input_span_)
        .label(channel.unit_span, "this channel", false);
    return false;
  }

  // A module on a companion reads one device there. There is one of each kind, so `input` may be left out.
  void check_device() {
    const auto* value = fields_.find("input");
    if (value == nullptr || !read_text(*value, diagnostics_)) return;
    if (same_name(value->text, module_->device)) return;
    diagnostics_
        .report(Code::E0205, shown() + " reads the " + module_->device +
                                 " of the companion computer, not a sensor of the robot")
        .label(value->span)
        .helps("write \"" + module_->device + "\", or remove `input`");
  }

  // ---- its rate

  // The period of its input; if the input is fed, its own.
  std::uint16_t period(const SensorConfig& input) {
    const auto* rate = fields_.find("rate");
    const bool fed = input.driver == vm::DriverId::virtual_sensor || input.period_ms == 0;
    if (rate != nullptr && !fed) {
      diagnostics_
          .report(Code::E0205, "an algorithm runs whenever its input is sampled, but " +
                                   input.name.shown() + " has its own rate")
          .label(rate->span)
          .helps("set the rate of its channels, and remove this one");
      return input.period_ms;
    }
    return period_in_range(fed ? module_->usual_period_ms : input.period_ms, input_span_);
  }

  // Takes `period` unless there is a `rate`. A period out of range is reported, at `span` if there is no `rate`.
  std::uint16_t period_in_range(std::uint16_t period, Span span) {
    const auto* rate = fields_.find("rate");
    if (rate != nullptr) period = read_rate(*rate, diagnostics_).value_or(period);
    if (period >= module_->shortest_period_ms && period <= module_->longest_period_ms)
      return period;
    diagnostics_
        .report(Code::E0205, shown() + " works from " + hertz(module_->longest_period_ms) + " to " +
                                 hertz(module_->shortest_period_ms) + ", not at " + hertz(period))
        .label(rate != nullptr ? rate->span : span)
        .helps(rate != nullptr ? "change this rate" : "change the `rate` of its channels");
    return module_->usual_period_ms;
  }

  static std::string hertz(std::uint16_t period_ms) {
    const Unit& unit = canonical_unit(vm::Dimension::frequency);
    return format_value((1000 * vm::kScale + period_ms / 2) / period_ms, unit);
  }

  // ---- its parameters

  // `unit`: for parameters that are measured in the unit of the input.
  std::vector<vm::Value> config(const Unit& unit) {
    std::vector<vm::Value> values;
    for (const ModuleParameter& parameter : module_->parameters)
      values.push_back(parameter.usual);
    const auto* object = fields_.find("config");
    if (object == nullptr || !expect_kind(*object, json::Kind::object, diagnostics_)) return values;
    report_repeated_keys(*object, diagnostics_);
    for (const json::Member& member : object->members)
      if (is_words_file(member)) {
        words_ = &member.value;
      } else if (const auto place = find_parameter(member)) {
        const ModuleParameter& parameter = module_->parameters[*place];
        read_parameter(member.value, parameter,
                       parameter.dimension ? canonical_unit(*parameter.dimension) : unit,
                       values[*place]);
      }
    return values;
  }

  std::optional<std::size_t> find_parameter(const json::Member& member) {
    std::vector<std::string> known = names_of(module_->parameters);
    const auto found = std::ranges::find(known, member.key);
    if (found != known.end()) return static_cast<std::size_t>(found - known.begin());
    if (is_taught()) known.emplace_back(kWordsKey);
    has_unknown_key_ = true;
    Diagnostic& d =
        diagnostics_.report(Code::E0202, shown() + " has no parameter `" + member.key + "`")
            .label(member.key_span);
    if (!did_you_mean(d, member.key_span, member.key, known, "\""))
      d.helps("it can be " + list_names(known, "or"));
    return std::nullopt;
  }

  void read_parameter(const json::Value& value, const ModuleParameter& parameter, const Unit& unit,
                      vm::Value& into) {
    const auto read = read_quantity(value, unit, diagnostics_);
    if (!read) return;
    const bool fits = !parameter.is_whole || *read % vm::kScale == 0;
    if (fits && *read >= parameter.min && *read <= parameter.max) {
      into = *read;
      return;
    }
    const std::string what = parameter.is_whole ? "a whole number " : "";
    diagnostics_
        .report(Code::E0205, "this must be " + what + "from " + format_value(parameter.min, unit) +
                                 " to " + format_value(parameter.max, unit))
        .label(value.span);
  }

  // ---- its words

  bool is_taught() const { return std::ranges::any_of(module_->outputs, &ModuleOutput::is_taught); }
  bool is_words_file(const json::Member& member) const {
    return is_taught() && member.key == kWordsKey;
  }

  // The file is next to robot.json and named after the algorithm, unless `words` names another.
  bool add_taught_words(const Spelled& name, SensorConfig& sensor) {
    if (words_ == nullptr && has_unknown_key_) return false;  // which may be a misspelt `words`
    if (words_ != nullptr && !read_text(*words_, diagnostics_)) return false;
    const std::string file = in_folder(words_ != nullptr ? words_->text : name.text + ".words");
    sensor.words_file = file;
    sensor.taught_by = module_->name;
    const WordsInFile found =
        modules_.words_in_file != nullptr ? modules_.words_in_file(file) : WordsInFile{};
    if (!found.why_not.empty()) {
      diagnostics_
          .report(Code::E0211, name.shown() + " has no words: " + file + " " + found.why_not)
          .label(words_ != nullptr ? words_->span : name.span)
          .helps("`rsc teach " + name.text + " WORD one.wav two.wav three.wav` teaches it a word");
      return false;
    }
    if (sensor.algorithm && !take_constants(name, found, sensor.algorithm->config)) return false;
    for (ChannelConfig& channel : sensor.channels)
      if (module_->outputs[channel.input].is_taught) {
        channel.learns_words = modules_.words_in_file == nullptr;
        for (const std::string& word : found.words)
          channel.add_label(word);
      }
    return true;
  }

  // They go to the board with the program.
  bool take_constants(const Spelled& name, const WordsInFile& found,
                      std::vector<vm::Value>& config) {
    if (found.constants.size() > module_->most_constants) {
      diagnostics_
          .report(Code::E0205, name.shown() + " was taught " + std::to_string(found.words.size()) +
                                   " words, which take " + std::to_string(found.constants.size()) +
                                   " numbers; the board holds " +
                                   std::to_string(module_->most_constants))
          .label(words_ != nullptr ? words_->span : name.span)
          .helps("`rsc teach " + name.text + " --forget WORD` takes one away")
          .helps(kElsewhere);
      return false;
    }
    config.push_back(static_cast<vm::Value>(found.constants.size()));
    config.insert(config.end(), found.constants.begin(), found.constants.end());
    return true;
  }

  // ---- its channels

  ChannelConfig channel(const Spelled& name, const ModuleOutput& output) const {
    ChannelConfig channel;
    channel.name = {output.name, name.span};
    channel.unit = &canonical_unit(output.dimension);
    channel.unit_span = name.span;
    channel.input = static_cast<std::uint8_t>(&output - module_->outputs.data());
    channel.min = output.min;
    channel.max = output.max;
    channel.labels = output.labels;
    channel.learns_words = output.learns_words;
    return channel;
  }

  // Its outputs go stale as soon as the first of the channels that it reads.
  std::uint16_t stale_as(const SensorConfig& input) const {
    std::uint16_t soonest = 0;
    for (std::size_t i = 0; i < module_->inputs.size(); ++i) {
      const std::uint16_t stale = input.channels[first_of(input) + i].stale_ms;
      if (stale != 0 && (soonest == 0 || stale < soonest)) soonest = stale;
    }
    return soonest;
  }

  Fields fields_;
  std::filesystem::path folder_;
  const AlgorithmModules& modules_;
  Robot& robot_;
  Diagnostics& diagnostics_;
  const AlgorithmModule* module_ = nullptr;
  std::uint8_t number_ = 0;  // of the module
  const json::Value* on_ = nullptr;
  const json::Value* words_ = nullptr;
  bool has_unknown_key_ = false;
  std::optional<bool> wants_companion_;  // nullopt: there is no `on`
  Span input_span_;
};

}  // namespace

bool read_algorithm(const json::Value& value, const std::string& file,
                    const AlgorithmModules& modules, Robot& robot, Diagnostics& diagnostics) {
  return AlgorithmReader(value, file, modules, robot, diagnostics).read();
}

}  // namespace robosync::compiler
