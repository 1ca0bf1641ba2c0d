#include "compiler/sema/limits.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "compiler/diagnostics/nearest.hpp"

namespace robosync::compiler {
namespace {

constexpr std::string_view kSpeed = "SPEED";

}  // namespace

void Limits::add(const ast::Limit& limit, std::uint16_t line, ir::Program& program) {
  if (limit.value == nullptr || limit.actuator.text.empty() || limit.channel.text.empty()) return;
  const auto target = names_.find_target(limit.actuator.text);
  if (target && same_name(limit.channel.text, kSpeed)) return limit_speed(limit, *target, program);
  if (const auto channel = find_channel(limit))
    return limit_reading(limit, *channel, line, program);
  report_unknown(limit);
}

std::optional<ChannelRef> Limits::find_channel(const ast::Limit& limit) const {
  const auto sensor = names_.find_sensor(limit.actuator.text);
  if (!sensor) return std::nullopt;
  const auto& channels = robot_.sensors[*sensor].channels;
  const auto found =
      std::find_if(channels.begin(), channels.end(), [&](const ChannelConfig& channel) {
        return same_name(channel.name.text, limit.channel.text);
      });
  if (found == channels.end()) return std::nullopt;
  return ChannelRef{*sensor, static_cast<std::size_t>(found - channels.begin())};
}

void Limits::report_unknown(const ast::Limit& limit) {
  const auto sensor = names_.find_sensor(limit.actuator.text);
  if (!sensor && !names_.find_target(limit.actuator.text)) {
    Diagnostic& d =
        diagnostics_.report(Code::E0501, "there is no actuator " + limit.actuator.shown())
            .label(limit.actuator.span);
    if (diagnostics_.may_search(robot_.actuators.size() + robot_.groups.size()))
      did_you_mean(d, limit.actuator.span, limit.actuator.text, names_.target_names());
    names_.doubt_group(d, limit.actuator.text);
    return;
  }
  Diagnostic& d = diagnostics_
                      .report(Code::E0501, limit.actuator.shown() + " has no " +
                                               limit.channel.shown() + " to limit")
                      .label(limit.channel.span);
  if (!diagnostics_.may_search(sensor ? robot_.sensors[*sensor].channels.size() : 1)) return;
  std::vector<std::string> candidates;
  if (names_.find_target(limit.actuator.text)) candidates.emplace_back(kSpeed);
  if (sensor)
    for (const ChannelConfig& channel : robot_.sensors[*sensor].channels)
      candidates.push_back(channel.name.text);
  did_you_mean(d, limit.channel.span, limit.channel.text, candidates);
  if (d.help.empty())
    d.helps("it has " + list_names(candidates) +
            (sensor ? "" : "; to limit more, add a sensor named " + limit.actuator.shown()));
}

void Limits::limit_speed(const ast::Limit& limit, const Target& target, ir::Program& program) {
  const Unit* unit = nullptr;
  std::optional<Typed> speed;
  for (const std::size_t place : target.actuators) {
    ActuatorConfig& actuator = robot_.actuators[place];
    if (actuator.at_unit == nullptr) {
      diagnostics_.report(Code::E0505, actuator.name.shown() + " has no speed to limit")
          .label(limit.actuator.span);
      return;
    }
    // Once for a group, so that its members do not repeat what there is to report.
    if (std::exchange(unit, actuator.at_unit) != actuator.at_unit)
      speed = expressions_.constant_amount(
          *limit.value, {actuator.at_unit, "SPEED of " + actuator.name.text, actuator.name.span});
    if (!speed) return;
    if (speed->code.constant <= 0) {
      diagnostics_.report(Code::E0509, "a speed must be above 0").label(limit.value->span);
      return;
    }
    if (speed->code.constant >= actuator.speed_limit) continue;
    actuator.speed_limit = speed->code.constant;
    actuator.limit_span = limit.value->span;
    std::erase_if(program.speed_limits, [&](const auto& known) { return known.first == place; });
    program.speed_limits.emplace_back(place, speed->code.constant);
  }
}

// WHEN x CH > limit DO STOP x RESUME WHEN x CH <= limit
void Limits::limit_reading(const ast::Limit& limit, ChannelRef channel, std::uint16_t line,
                           ir::Program& program) {
  const auto target = names_.find_target(limit.actuator.text);
  if (!target) {
    diagnostics_.report(Code::E0501, "there is no actuator " + limit.actuator.shown() + " to stop")
        .label(limit.actuator.span)
        .helps("give a group in robot.json the name of the sensor");
    return;
  }
  const ChannelConfig& config = names_.channel(channel);
  const std::string name = names_.channel_name(channel);
  if (!config.labels.empty()) {
    diagnostics_.report(Code::E0306, "`" + name + "` is a word, so it cannot have a LIMIT")
        .label(limit.channel.span);
    return;
  }
  const auto most =
      expressions_.constant_amount(*limit.value, {config.unit, name, config.unit_span});
  if (!most) return;
  Expression reading;
  reading.operation = Operation::input;
  reading.channel = channel;
  const Expression number = make_constant_code(most->code.constant);
  ir::Rule rule;
  rule.kind = vm::RuleKind::safety;
  rule.line = line;
  rule.span = limit.actuator.span;
  rule.condition = make_binary(Operation::greater, reading, number);
  rule.resume = make_binary(Operation::less_equal, reading, number);
  rule.then_response.push_back(
      {ir::Halt{false, target->group, target->actuators}, line, limit.actuator.span});
  program.safety.push_back(std::move(rule));
}

}  // namespace robosync::compiler
