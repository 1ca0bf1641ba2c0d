#include "tests/compiler/build.hpp"

#include <cmath>

#include <catch2/catch.hpp>

#include "compiler/codegen/verify_image.hpp"
#include "compiler/optimize/optimize.hpp"
#include "vm/disassembler.hpp"

namespace robosync::compiler::testing {
namespace {

constexpr std::uint8_t kAllParams = 0xFF;
// In a function, for constants of other files are made of it.
const ir::Verb& move_verb() {
  static const ir::Verb verb{"MOVE", vm::Action::move, kAllParams};
  return verb;
}

ChannelConfig channel_config(std::string name, vm::Dimension dimension) {
  ChannelConfig config;
  config.name.text = std::move(name);
  config.unit = &canonical_unit(dimension);
  return config;
}

ActuatorConfig actuator_config(std::string name) {
  ActuatorConfig config;
  config.name.text = std::move(name);
  config.driver = vm::DriverId::virtual_actuator;
  const ir::Verb& verb = move_verb();
  config.verbs.push_back({verb.name, verb.action, verb.takes, Texts::none});
  return config;
}

SensorConfig sensor_config(std::string name, std::vector<ChannelConfig> channels) {
  SensorConfig config;
  config.name.text = std::move(name);
  config.driver = vm::DriverId::virtual_sensor;
  config.channels = std::move(channels);
  return config;
}

vm::Value thousandths(double units) {
  return static_cast<vm::Value>(std::lround(units * vm::kScale));
}

std::string text_of(const vm::Image& image, const vm::Behavior& behavior) {
  std::string text = "behaviour " + std::to_string(behavior.priority) + " inputs";
  for (unsigned i = 0; i < behavior.input_count; ++i)
    text += " " + std::to_string(image.inputs[behavior.first_input + i]);
  return text + " locals " + std::to_string(behavior.locals) + " cells " +
         std::to_string(behavior.cells) + " actuators " + std::to_string(behavior.actuators) + "\n";
}

std::string code_of(const vm::Image& image, std::size_t start, std::size_t length) {
  std::string text;
  char line[128];
  for (std::size_t at = start; at < start + length; ++at) {
    vm::disassemble(image, image.code[at], line);
    text += "    " + std::to_string(at - start) + (at - start < 10 ? "   " : "  ") + line + "\n";
  }
  return text;
}

std::string response_of(const vm::Image& image, const char* title, std::uint16_t index) {
  if (index == vm::kNoIndex) return {};
  const vm::Response& response = image.responses[index];
  return std::string("   ") + title + "\n" + code_of(image, response.start, response.length);
}

constexpr const char* kKinds[] = {"when",  "when_else", "while",  "every",
                                  "start", "watch",     "safety", "resume"};

}  // namespace

Robot small_robot() {
  Robot robot;
  robot.sensors.push_back(sensor_config("touch", {channel_config("LEVEL", vm::Dimension::number)}));
  robot.sensors.push_back(
      sensor_config("eye", {channel_config("DISTANCE", vm::Dimension::length),
                            channel_config("LIGHT", vm::Dimension::illuminance)}));
  ChannelConfig key = channel_config("KEY", vm::Dimension::number);
  key.labels = {"up", "down"};
  key.min = 0;
  key.max = vm::kScale;
  robot.sensors.push_back(sensor_config("key", {key}));
  for (const char* name : {"left", "right", "sound"})
    robot.actuators.push_back(actuator_config(name));
  robot.groups.push_back({{"arms", {}}, {0, 1}});
  return robot;
}

E number(double units) {
  E expression;
  expression.constant = thousandths(units);
  return expression;
}

E channel(std::size_t place) {
  constexpr ChannelRef kChannels[] = {{0, 0}, {1, 0}, {1, 1}, {2, 0}};
  E expression;
  expression.operation = Operation::input;
  expression.channel = kChannels[place];
  return expression;
}

E variable(std::size_t place) {
  E expression;
  expression.operation = Operation::variable;
  expression.index = place;
  return expression;
}

E local(std::size_t place) {
  E expression;
  expression.operation = Operation::local;
  expression.index = place;
  return expression;
}

E of(Operation operation, std::vector<E> operands) {
  E expression;
  expression.operation = operation;
  expression.operands = std::move(operands);
  return expression;
}

E time_word(Operation operation, double seconds, std::vector<E> operands, std::size_t count) {
  E expression = of(operation, std::move(operands));
  expression.constant = thousandths(seconds);
  expression.index = count;
  return expression;
}

E less(E left, E right) {
  return of(Operation::less, {std::move(left), std::move(right)});
}

E greater(E left, E right) {
  return of(Operation::greater, {std::move(left), std::move(right)});
}

E held(E condition, double seconds) {
  return time_word(Operation::held, seconds, {std::move(condition)});
}

ir::Command move(std::size_t actuator, std::vector<ir::Argument> arguments) {
  return {std::nullopt, {actuator}, move_verb(), std::nullopt, std::move(arguments)};
}

ir::Command move_arms(std::vector<ir::Argument> arguments) {
  return {0, {0, 1}, move_verb(), std::nullopt, std::move(arguments)};
}

ir::Rule when(E condition, ir::Block then_response) {
  ir::Rule rule;
  rule.condition = std::move(condition);
  rule.then_response = std::move(then_response);
  rule.line = 1;
  return rule;
}

ir::Rule at_start(ir::Block then_response) {
  ir::Rule rule = when({}, std::move(then_response));
  rule.kind = vm::RuleKind::start;
  return rule;
}

ir::Program program_of(std::vector<ir::Rule> rules, std::vector<ir::Variable> variables) {
  ir::Program program;
  program.variables = std::move(variables);
  program.behaviors.push_back({50, "tested", std::move(rules)});
  return program;
}

ir::Variable plain(std::string name, double initial) {
  ir::Variable made;
  made.name = std::move(name);
  made.initial = thousandths(initial);
  return made;
}

ir::Variable ranged(std::string name, double min, double max) {
  ir::Variable made = plain(std::move(name), min);
  made.min = thousandths(min);
  made.max = thousandths(max);
  return made;
}

Built build(const ir::Program& program, BuildOptions options) {
  const Robot robot = small_robot();
  Built built;
  Emitted emitted = emit(options.optimize ? optimize(program, robot) : program, program, robot,
                         {.source_lines = options.source_lines}, built.diagnostics);
  if (built.diagnostics.errors() == 0 && verify_image(emitted, built.diagnostics))
    built.bytes = std::move(emitted.image);
  if (!built.bytes.empty()) REQUIRE(vm::view_image(built.bytes, built.image));
  return built;
}

Built must_build(const ir::Program& program, bool source_lines) {
  Built built = build(program, {.source_lines = source_lines});
  for (const Diagnostic& diagnostic : built.diagnostics.all())
    UNSCOPED_INFO(code_name(diagnostic.code) << " " << diagnostic.message);
  REQUIRE(!built.bytes.empty());
  return built;
}

std::string listing(const vm::Image& image) {
  std::string text;
  for (const vm::Behavior& behavior : image.behaviors) {
    text += text_of(image, behavior);
    for (unsigned i = 0; i < behavior.rule_count; ++i) {
      const vm::Rule& rule = image.rules[behavior.first_rule + i];
      text += std::string("  ") + kKinds[static_cast<std::size_t>(rule.kind)] + " line " +
              std::to_string(rule.line) + "\n";
      text += code_of(image, rule.condition_start, rule.condition_length);
      text += response_of(image, "then", rule.then_response);
      text += response_of(image, "else", rule.else_response);
    }
  }
  for (const vm::Timer& timer : image.timers)
    text += "timer kind " + std::to_string(static_cast<int>(timer.kind)) + " count " +
            std::to_string(timer.count) + " state " + std::to_string(timer.state) + " duration " +
            std::to_string(timer.duration) + "\n";
  return text;
}

}  // namespace robosync::compiler::testing
