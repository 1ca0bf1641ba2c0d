#include "compiler/sema/names.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "compiler/diagnostics/nearest.hpp"

namespace robosync::compiler {
namespace {

template <typename List>
std::optional<std::size_t> place_of(const List& list, std::string_view name) {
  const auto found = std::find_if(list.begin(), list.end(), [&](const auto& entry) {
    return same_name(entry.name.text, name);
  });
  if (found == list.end()) return std::nullopt;
  return static_cast<std::size_t>(found - list.begin());
}

std::vector<std::string> channel_names(const SensorConfig& sensor) {
  std::vector<std::string> names;
  for (const ChannelConfig& channel : sensor.channels)
    names.push_back(channel.name.text);
  return names;
}

}  // namespace

bool Names::names_a_channel(std::string_view name) const {
  return place_of(robot_.sensors, name).has_value() ||
         joined_channel({{std::string(name), {}}, {}}).has_value();
}

std::optional<ChannelRef> Names::joined_channel(const ast::Operand& operand) const {
  for (std::size_t s = 0; s < robot_.sensors.size(); ++s) {
    const SensorConfig& sensor = robot_.sensors[s];
    for (std::size_t c = 0; c < sensor.channels.size(); ++c)
      if (same_name(sensor.name.text + sensor.channels[c].name.text, operand.name.text))
        return ChannelRef{s, c};
  }
  return std::nullopt;
}

std::optional<ChannelRef> Names::channel_of_sensor(std::size_t sensor,
                                                   const ast::Operand& operand) {
  const SensorConfig& config = robot_.sensors[sensor];
  if (!operand.channel) {
    if (config.channels.size() == 1) return ChannelRef{sensor, 0};
    diagnostics_.report(Code::E0501, "`" + config.name.text + "` has several channels: say which")
        .label(operand.name.span)
        .helps("channels: " + list_names(channel_names(config)));
    return std::nullopt;
  }
  if (const auto channel = place_of(config.channels, operand.channel->text))
    return ChannelRef{sensor, *channel};
  const auto candidates = channel_names(config);
  Diagnostic& d = diagnostics_
                      .report(Code::E0501, "the sensor `" + config.name.text +
                                               "` has no channel `" + operand.channel->text + "`")
                      .label(operand.channel->span)
                      .label(config.name.span, "the sensor", false);
  suggest(d, operand.channel->span, operand.channel->text, candidates);
  if (d.help.empty()) d.helps("channels: " + list_names(candidates));
  return std::nullopt;
}

std::optional<ChannelRef> Names::find_channel(const ast::Operand& operand) {
  if (operand.name.text.empty()) return std::nullopt;
  if (const auto sensor = place_of(robot_.sensors, operand.name.text))
    return channel_of_sensor(*sensor, operand);
  if (const auto joined = operand.channel ? std::nullopt : joined_channel(operand)) return joined;
  report_unknown(operand);
  return std::nullopt;
}

void Names::report_unknown(const ast::Operand& operand) {
  std::vector<std::string> candidates;
  for (const SensorConfig& sensor : robot_.sensors) {
    candidates.push_back(sensor.name.text);
    if (!operand.channel)
      for (const ChannelConfig& channel : sensor.channels)
        candidates.push_back(sensor.name.text + channel.name.text);
  }
  if (!operand.channel)
    for (const auto& [folded, constant] : constants_)
      candidates.push_back(constant.let->name.text);
  if (!operand.channel)
    for (std::string& name : variable_names())
      candidates.push_back(std::move(name));
  const std::string what = operand.channel ? "sensor `" : "sensor, LET or variable called `";
  Diagnostic& d = diagnostics_.report(Code::E0501, "there is no " + what + operand.name.text + "`")
                      .label(operand.name.span);
  suggest(d, operand.name.span, operand.name.text, candidates);
  if (!d.help.empty()) return;
  candidates.clear();
  for (const SensorConfig& sensor : robot_.sensors)
    candidates.push_back(sensor.name.text);
  if (!candidates.empty()) d.helps("sensors: " + list_names(candidates));
}

ConstantName* Names::find_constant(std::string_view name) {
  const auto found = constants_.find(fold_name(name));
  return found == constants_.end() ? nullptr : &found->second;
}

DefineName* Names::find_define(std::string_view name) {
  const auto found = defines_.find(fold_name(name));
  return found == defines_.end() ? nullptr : &found->second;
}

VariableName* Names::find_variable(std::string_view name) {
  const std::string folded = fold_name(name);
  if (scope_ != nullptr) {
    const Places& places = private_[scope_];
    if (const auto found = places.find(folded); found != places.end())
      return &variables_[found->second];
  }
  const auto found = globals_.find(folded);
  return found == globals_.end() ? nullptr : &variables_[found->second];
}

const ast::Behavior* Names::set_scope(const ast::Behavior* behavior) {
  return std::exchange(scope_, behavior);
}

std::string Names::kind_of(std::string_view name) {
  constexpr std::array<std::string_view, static_cast<std::size_t>(vm::VariableKind::count_)>
      kKinds = {"a REMEMBER", "a STATE", "a FEELING", "a signal", "a CHECK"};
  if (const VariableName* variable = find_variable(name))
    return std::string(kKinds[static_cast<std::size_t>(variable->kind)]);
  if (find_constant(name) != nullptr) return "a LET";
  if (find_define(name) != nullptr) return "a DEFINE";
  if (names_a_channel(name)) return "a sensor";
  if (find_target(name)) return "an actuator";
  return claimed_.contains(fold_name(name)) ? "the name of a block" : "";
}

std::optional<std::size_t> Names::find_sensor(std::string_view name) const {
  return place_of(robot_.sensors, name);
}

std::optional<Target> Names::find_target(std::string_view name) const {
  if (const auto actuator = place_of(robot_.actuators, name))
    return Target{std::nullopt, {*actuator}, robot_.actuators[*actuator].name.text};
  const auto group = place_of(robot_.groups, name);
  if (!group) return std::nullopt;
  const GroupConfig& config = robot_.groups[*group];
  return Target{group, config.members, config.name.text};
}

bool Names::is_verb(std::string_view name) const {
  return std::any_of(robot_.actuators.begin(), robot_.actuators.end(),
                     [&](const auto& actuator) { return actuator.find_verb(name) != nullptr; });
}

std::string Names::channel_name(ChannelRef ref) const {
  return sensor(ref).name.text + " " + channel(ref).name.text;
}

std::vector<std::string> Names::target_names() const {
  std::vector<std::string> names;
  for (const ActuatorConfig& actuator : robot_.actuators)
    names.push_back(actuator.name.text);
  for (const GroupConfig& group : robot_.groups)
    names.push_back(group.name.text);
  return names;
}

std::vector<std::string> Names::verb_names() const {
  std::vector<std::string> names;
  for (const ActuatorConfig& actuator : robot_.actuators)
    for (const VerbConfig& verb : actuator.verbs)
      if (std::find(names.begin(), names.end(), verb.name) == names.end())
        names.push_back(verb.name);
  return names;
}

std::vector<std::string> Names::define_names() const {
  std::vector<std::string> names;
  for (const auto& [folded, define] : defines_)
    names.push_back(define.define->name.text);
  return names;
}

std::vector<std::string> Names::variable_names() const {
  std::vector<std::string> names;
  for (const auto& [folded, place] : globals_)
    names.push_back(variables_[place].name.text);
  if (const auto own = private_.find(scope_); own != private_.end())
    for (const auto& [folded, place] : own->second)
      names.push_back(variables_[place].name.text);
  return names;
}

void suggest(Diagnostic& diagnostic, Span span, std::string_view word,
             const std::vector<std::string>& candidates) {
  if (const auto near = nearest(word, candidates))
    diagnostic.helps("did you mean `" + *near + "`?").fix(span, *near);
}

}  // namespace robosync::compiler
