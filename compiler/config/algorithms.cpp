#include "compiler/config/algorithms.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "compiler/config/entries.hpp"
#include "compiler/config/fields.hpp"
#include "compiler/config/values.hpp"
#include "compiler/diagnostics/nearest.hpp"
#include "runtime-m4/algorithms/modules.hpp"

namespace robosync::compiler {
namespace {

using algorithms::find_description;

constexpr std::uint8_t number_of(vm::Dimension dimension) {
  return static_cast<std::uint8_t>(dimension);
}
static_assert(ROBOSYNC_NUMBER == number_of(vm::Dimension::number) &&
              ROBOSYNC_SECONDS == number_of(vm::Dimension::duration) &&
              ROBOSYNC_G == number_of(vm::Dimension::acceleration));
static_assert(ROBOSYNC_ONE == vm::kScale && ROBOSYNC_UNKNOWN == vm::kUnknown);

class AlgorithmReader {
public:
  AlgorithmReader(const json::Value& value, Robot& robot, Diagnostics& diagnostics)
      : fields_(value, Object::algorithm, diagnostics), robot_(robot), diagnostics_(diagnostics) {}

  bool read() {
    const auto name = read_name(fields_, "an algorithm", diagnostics_);
    if (!name || !is_on_board()) return false;
    if (const auto* path = fields_.find("path")) {
      report_file(*name, *path);
      return true;
    }
    if (!find_module()) return false;
    const SensorConfig* const input = find_input();
    if (input == nullptr || !can_read(*input)) return false;
    SensorConfig sensor;
    sensor.name = *name;
    sensor.driver = vm::DriverId::algorithm;
    sensor.period_ms = period(*input);
    sensor.algorithm = {number_, static_cast<std::size_t>(input - robot_.sensors.data()),
                        module().inputs, config(input->channels.front())};
    for (std::size_t i = 0; i < module().outputs; ++i)
      sensor.channels.push_back(channel(*name, i, *input));
    robot_.sensors.push_back(std::move(sensor));
    return true;
  }

private:
  const robosync_module& module() const { return *description_->module; }
  std::string shown() const { return "`" + std::string(description_->name) + "`"; }

  // ---- which module

  bool is_on_board() {
    const auto* on = fields_.find("on");
    if (on == nullptr) return true;
    constexpr std::array<std::string_view, 2> kPlaces = {"board", "companion"};
    const auto place = read_choice(*on, kPlaces, diagnostics_);
    if (place == 1u)
      diagnostics_
          .report(
              Code::E0205,
              "this version of rsc runs algorithms on the board only, not on a companion computer")
          .label(on->span)
          .helps("leave `on` out, with a module of the firmware");
    return place == 0u;
  }

  void report_file(const Spelled& name, const json::Value& path) {
    diagnostics_
        .report(Code::W0214, "this version of rsc cannot load modules from files: " + name.shown() +
                                 " does nothing")
        .label(path.span)
        .helps("the modules of the firmware are named with \"module\": " + list_names(names()));
  }

  static std::vector<std::string> names() {
    std::vector<std::string> names;
    for (std::size_t i = 0; const auto* description = find_description(i); ++i)
      names.emplace_back(description->name);
    return names;
  }

  bool find_module() {
    const auto* value = fields_.require("module", "an algorithm");
    if (value == nullptr || !read_text(*value, diagnostics_)) return false;
    const std::vector<std::string> known = names();
    const auto found = std::ranges::find(known, value->text);
    if (found != known.end()) {
      number_ = static_cast<std::uint8_t>(found - known.begin());
      description_ = find_description(number_);
      return true;
    }
    Diagnostic& d =
        diagnostics_
            .report(Code::E0209, "the firmware has no algorithm module `" + value->text + "`")
            .label(value->span);
    if (const auto near = nearest(value->text, known))
      d.helps("did you mean `" + *near + "`?").fix(value->span, "\"" + *near + "\"");
    else
      d.helps("it has " + list_names(known));
    return false;
  }

  // ---- what it reads

  const SensorConfig* find_input() {
    const auto* value = fields_.require("input", shown());
    if (value == nullptr || !read_text(*value, diagnostics_)) return nullptr;
    input_span_ = value->span;
    for (const SensorConfig& sensor : robot_.sensors)
      if (same_name(sensor.name.text, value->text)) return usable(sensor);
    std::vector<std::string> known;
    for (const SensorConfig& sensor : robot_.sensors)
      if (!sensor.algorithm) known.push_back(sensor.name.text);
    Diagnostic& d = diagnostics_.report(Code::E0501, "there is no sensor `" + value->text + "`")
                        .label(value->span);
    if (const auto near = nearest(value->text, known))
      d.helps("did you mean `" + *near + "`?").fix(value->span, "\"" + *near + "\"");
    else if (!known.empty())
      d.helps("sensors: " + list_names(known));
    return nullptr;
  }

  const SensorConfig* usable(const SensorConfig& sensor) {
    if (!sensor.algorithm) return &sensor;
    diagnostics_.report(Code::E0205, "an algorithm cannot read another algorithm")
        .label(input_span_)
        .helps("name the sensor itself");
    return nullptr;
  }

  // Its first channels, in their order.
  bool can_read(const SensorConfig& sensor) {
    const std::size_t needed = module().inputs;
    if (sensor.channels.size() < needed) {
      std::vector<std::string> wanted;
      for (std::size_t i = 0; i < needed; ++i)
        wanted.emplace_back(description_->inputs[i].name);
      diagnostics_
          .report(Code::E0205, shown() + " reads " + std::to_string(needed) + " channels, and " +
                                   sensor.name.shown() + " has " +
                                   std::to_string(sensor.channels.size()))
          .label(input_span_)
          .helps("in this order: " + list_names(wanted));
      return false;
    }
    for (std::size_t i = 0; i < needed; ++i)
      if (!can_read(sensor.channels[i], description_->inputs[i])) return false;
    return true;
  }

  bool can_read(const ChannelConfig& channel, const robosync_input& input) {
    const bool any = input.unit == ROBOSYNC_AS_INPUT;
    if (channel.labels.empty() && (any || input.unit == number_of(channel.unit->dimension)))
      return true;
    const std::string what =
        any ? "numbers" : std::string(dimension_phrase(static_cast<vm::Dimension>(input.unit)));
    const std::string is = channel.labels.empty()
                               ? std::string(dimension_phrase(channel.unit->dimension))
                               : std::string("words");
    diagnostics_
        .report(Code::E0205, shown() + " needs " + what + " as its " + input.name + ", and " +
                                 channel.name.shown() + " gives " + is)
        .label(input_span_)
        .label(channel.unit_span, "this channel", false);
    return false;
  }

  // ---- how often

  // That of its input; of one that is fed, its own.
  std::uint16_t period(const SensorConfig& input) {
    const auto* rate = fields_.find("rate");
    const bool fed = input.driver == vm::DriverId::virtual_sensor || input.period_ms == 0;
    if (rate != nullptr && !fed) {
      diagnostics_
          .report(Code::E0205, "an algorithm runs whenever its input is sampled, and " +
                                   input.name.shown() + " has a rate")
          .label(rate->span)
          .helps("set the rate of its channels, and leave this one out");
      return input.period_ms;
    }
    std::uint16_t period = fed ? description_->usual_period_ms : input.period_ms;
    if (rate != nullptr) period = read_rate(*rate, diagnostics_).value_or(period);
    if (period >= module().shortest_period_ms && period <= module().longest_period_ms)
      return period;
    diagnostics_
        .report(Code::E0205, shown() + " works from " + hertz(module().longest_period_ms) + " to " +
                                 hertz(module().shortest_period_ms) + ", not at " + hertz(period))
        .label(rate != nullptr ? rate->span : input_span_)
        .helps(rate != nullptr ? "change this rate" : "change the `rate` of its channels");
    return description_->usual_period_ms;
  }

  static std::string hertz(std::uint16_t period_ms) {
    const Unit& unit = canonical_unit(vm::Dimension::frequency);
    return format_value((1000 * vm::kScale + period_ms / 2) / period_ms, unit);
  }

  // ---- its parameters

  std::vector<vm::Value> config(const ChannelConfig& input) {
    std::vector<vm::Value> values;
    for (std::size_t p = 0; p < module().parameters; ++p)
      values.push_back(module().ranges[p].usual);
    const auto* object = fields_.find("config");
    if (object == nullptr || !expect_kind(*object, json::Kind::object, diagnostics_)) return values;
    report_repeated_keys(*object, diagnostics_);
    for (const json::Member& member : object->members)
      if (const auto place = find_parameter(member)) {
        const std::uint8_t unit = description_->parameters[*place].unit;
        read_parameter(member.value, module().ranges[*place],
                       unit == ROBOSYNC_AS_INPUT ? *input.unit
                                                 : canonical_unit(static_cast<vm::Dimension>(unit)),
                       values[*place]);
      }
    return values;
  }

  std::optional<std::size_t> find_parameter(const json::Member& member) {
    std::vector<std::string> known;
    for (std::size_t p = 0; p < module().parameters; ++p)
      known.emplace_back(description_->parameters[p].name);
    const auto found = std::ranges::find(known, member.key);
    if (found != known.end()) return static_cast<std::size_t>(found - known.begin());
    Diagnostic& d =
        diagnostics_.report(Code::E0202, shown() + " has no parameter `" + member.key + "`")
            .label(member.key_span);
    if (const auto near = nearest(member.key, known))
      d.helps("did you mean `" + *near + "`?").fix(member.key_span, "\"" + *near + "\"");
    else
      d.helps("it can be " + list_names(known, "or"));
    return std::nullopt;
  }

  void read_parameter(const json::Value& value, const robosync_range& range, const Unit& unit,
                      vm::Value& parameter) {
    const auto read = read_quantity(value, unit, diagnostics_);
    if (!read) return;
    if (*read >= range.least && *read <= range.most) {
      parameter = *read;
      return;
    }
    diagnostics_
        .report(Code::E0205, "this must be from " + format_value(range.least, unit) + " to " +
                                 format_value(range.most, unit))
        .label(value.span);
  }

  // ---- its channels

  ChannelConfig channel(const Spelled& name, std::size_t place, const SensorConfig& input) const {
    const robosync_output& output = description_->outputs[place];
    ChannelConfig channel;
    channel.name = {output.name, name.span};
    channel.unit = &canonical_unit(static_cast<vm::Dimension>(output.unit));
    channel.unit_span = name.span;
    channel.input = static_cast<std::uint8_t>(place);
    channel.min = output.least;
    channel.max = output.most;
    channel.labels.assign(output.labels, output.labels + output.label_count);
    // It is as old as what it was made of.
    for (std::size_t i = 0; i < module().inputs; ++i) {
      const std::uint16_t stale = input.channels[i].stale_ms;
      if (stale != 0 && (channel.stale_ms == 0 || stale < channel.stale_ms))
        channel.stale_ms = stale;
    }
    return channel;
  }

  Fields fields_;
  Robot& robot_;
  Diagnostics& diagnostics_;
  const robosync_description* description_ = nullptr;
  std::uint8_t number_ = 0;
  Span input_span_;
};

}  // namespace

bool read_algorithm(const json::Value& value, Robot& robot, Diagnostics& diagnostics) {
  return AlgorithmReader(value, robot, diagnostics).read();
}

}  // namespace robosync::compiler
