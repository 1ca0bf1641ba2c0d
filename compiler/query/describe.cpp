#include "compiler/query/describe.hpp"

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "compiler/explain/actuators.hpp"
#include "compiler/explain/rules.hpp"

namespace robosync::compiler::query {
namespace {

constexpr std::string_view kKinds[] = {
#define SYMBOL_KIND(name, said) said,
#include "compiler/query/symbol_kinds.def"
#undef SYMBOL_KIND
};

std::string spoken(std::string_view text) {
  return fmt::format("`{}`", text);
}

std::vector<std::string> names_of(const auto& list) {
  std::vector<std::string> names;
  names.reserve(list.size());
  for (const auto& one : list)
    names.push_back(spoken(one.name.text));
  return names;
}

std::string range_of(const ChannelConfig& channel) {
  if (!channel.labels.empty()) {
    std::vector<std::string> labels;
    for (const std::string& label : channel.labels)
      labels.push_back(spoken(label));
    return "one of " + explain::list(labels);
  }
  return fmt::format("from {} to {}", format_value(channel.min, *channel.unit),
                     format_value(channel.max, *channel.unit));
}

std::string about_robot(const Symbol& symbol, const Robot& robot) {
  switch (symbol.kind) {
    case SymbolKind::sensor: {
      const SensorConfig& sensor = robot.sensors.at(symbol.owner);
      return fmt::format("Device: {}.\nChannels: {}.", sensor.device,
                         explain::list(names_of(sensor.channels)));
    }
    case SymbolKind::channel: {
      const SensorConfig& sensor = robot.sensors.at(symbol.owner);
      const ChannelConfig& channel = sensor.channels.at(symbol.place);
      return fmt::format("Its value is {}\nDevice: {}.", describe_channel(channel), sensor.device);
    }
    case SymbolKind::actuator:
      return fmt::format("Device: {}.{}", robot.actuators.at(symbol.owner).device,
                         describe_actuator(robot.actuators.at(symbol.owner)));
    case SymbolKind::group: {
      std::vector<std::string> members;
      for (const std::size_t member : robot.groups.at(symbol.owner).members)
        members.push_back(spoken(robot.actuators.at(member).name.text));
      return fmt::format("Members: {}.", explain::list(members));
    }
    default:
      return {};
  }
}

// Describes the verb for each actuator that knows it.
std::string about_verb(const Symbol& symbol, const Robot& robot) {
  std::string text;
  for (const ActuatorConfig& actuator : robot.actuators)
    if (const VerbConfig* verb = actuator.find_verb(symbol.name))
      text += (text.empty() ? "" : "\n") + describe_verb(actuator, *verb);
  return text;
}

std::string about_word(const Symbol& symbol, const Robot& robot) {
  std::string text;
  for (const ActuatorConfig& actuator : robot.actuators)
    if (const WordConfig* word = actuator.find_word(symbol.name))
      text += (text.empty() ? "" : "\n") + describe_word(actuator, *word);
  return text;
}

std::string about_function(std::string_view name) {
  if (name == "ABS") return "The number without its sign.";
  if (name == "ROUND") return "The nearest whole number.";
  return name == "MIN" ? "The smaller of two numbers." : "The larger of two numbers.";
}

bool has_no_line(SymbolKind kind) {
  return kind >= SymbolKind::label || kind == SymbolKind::parameter;
}

// The line of the declaration, without the spaces around it.
std::string line_of(const Symbol& symbol, const Project& project) {
  if (has_no_line(symbol.kind) || !symbol.declared) return {};
  const SourceFile& source = project.sources.file(symbol.declared->file);
  std::string_view line = source.line(source.line_of(symbol.declared->begin));
  line = line.substr(std::min(line.find_first_not_of(" \t"), line.size()));
  return std::string(line.substr(0, line.find_last_not_of(" \t") + 1));
}

}  // namespace

std::string describe_channel(const ChannelConfig& channel) {
  const std::string range = range_of(channel);
  if (channel.period_ms == 0) return range + ". It has a value when it is fed one.";
  return fmt::format("{}. It is read every {} ms.", range, channel.period_ms);
}

std::string describe_actuator(const ActuatorConfig& actuator) {
  std::vector<std::string> verbs;
  for (const VerbConfig& verb : actuator.verbs)
    verbs.push_back(spoken(verb.name));
  std::string text;
  if (!verbs.empty()) text += fmt::format("\nVerbs: {}.", explain::list(verbs));
  if (actuator.to_unit != nullptr)
    text += fmt::format("\nRange: from {} to {}.", format_value(actuator.min, *actuator.to_unit),
                        format_value(actuator.max, *actuator.to_unit));
  if (actuator.speed_limit != vm::kValueMax && actuator.at_unit != nullptr)
    text += fmt::format("\nNever faster than {}.",
                        format_value(actuator.speed_limit, *actuator.at_unit));
  if (actuator.acceleration != 0)
    text += fmt::format("\nSpeeds up and slows down by no more than {}.",
                        format_acceleration(actuator.acceleration, *actuator.at_unit));
  return text;
}

std::string describe_verb(const ActuatorConfig& actuator, const VerbConfig& verb) {
  constexpr std::array<std::string_view, static_cast<std::size_t>(vm::Param::count_)> kNames = {
#define PARAM(name, spelling, doc) spelling,
#include "vm/params.def"
#undef PARAM
  };
  std::vector<std::string> takes;
  for (std::size_t param = 0; param < kNames.size(); ++param) {
    const bool has = verb.has(static_cast<vm::Param>(param));
    if (has && !kNames.at(param).empty()) takes.emplace_back(kNames.at(param));
  }
  const std::vector<std::string> words = actuator.words_of(verb);
  std::string text = fmt::format("{} {}", verb.name, actuator.name.text);
  if (verb.texts != Texts::none) text += " takes a text";
  if (!takes.empty())
    text +=
        fmt::format("{} {}", verb.texts == Texts::none ? " takes" : ",", fmt::join(takes, ", "));
  if (!words.empty()) text += fmt::format("; words: {}", fmt::join(words, ", "));
  return text + ".";
}

std::string describe_word(const ActuatorConfig& actuator, const WordConfig& word) {
  const Unit* unit = nullptr;
  if (word.param == vm::Param::at) unit = actuator.at_unit;
  if (word.param == vm::Param::to || word.param == vm::Param::by) unit = actuator.to_unit;
  if (unit == nullptr) return fmt::format("{} knows it.", actuator.name.text);
  return fmt::format("{}: {}.", actuator.name.text, format_value(word.value, *unit));
}

std::string comment_above(const SourceFile& source, std::uint32_t offset) {
  constexpr std::uint32_t kMostLines = 12;
  std::string text;
  const std::uint32_t own = source.line_of(offset);
  for (std::uint32_t line = own; line-- > 1 && own - line <= kMostLines;) {
    std::string_view words = source.line(line);
    const std::size_t sign = words.find_first_not_of(" \t");
    if (sign == std::string_view::npos || (words[sign] != '%' && words[sign] != '#')) break;
    words.remove_prefix(sign);
    words.remove_prefix(std::min(words.find_first_not_of("%# \t"), words.size()));
    if (!text.empty()) text.insert(0, 1, '\n');
    text.insert(0, words);
  }
  return text;
}

Description describe(const Symbol& symbol, const Project& project) {
  Description result;
  result.kind = kKinds[static_cast<std::size_t>(symbol.kind)];
  if (symbol.kind == SymbolKind::channel)
    result.kind += " " + spoken(project.robot.sensors.at(symbol.owner).name.text);
  else if (!symbol.within.empty() && symbol.kind <= SymbolKind::label)
    result.kind += (symbol.kind == SymbolKind::remember ? " of " : " ") + spoken(symbol.within);
  result.code = line_of(symbol, project);
  result.text = about_robot(symbol, project.robot);
  if (symbol.kind == SymbolKind::verb) result.text = about_verb(symbol, project.robot);
  if (symbol.kind == SymbolKind::word) result.text = about_word(symbol, project.robot);
  if (symbol.kind == SymbolKind::function) result.text = about_function(symbol.name);
  if (symbol.declared && !has_no_line(symbol.kind))
    result.text =
        comment_above(project.sources.file(symbol.declared->file), symbol.declared->begin);
  return result;
}

// ---- rules

namespace {

class RuleFinder {
public:
  RuleFinder(const Project& project, const SourceFile& source, std::uint32_t offset)
      : source_(source),
        offset_(offset),
        line_(source.line_of(offset)),
        defines_(explain::defines_of(project.trees)) {}

  void look(const ast::Item& item) {
    if (const auto* rule = std::get_if<ast::Rule>(&item.node)) look(*rule);
    if (const auto* behavior = std::get_if<ast::Behavior>(&item.node))
      for (const ast::Rule& rule : behavior->rules)
        look(rule);
    const auto* safety = std::get_if<ast::Safety>(&item.node);
    if (safety != nullptr && is_head(item.span)) text = explain::safety_text(*safety, defines_, 0);
  }

  std::string text;

private:
  void look(const ast::Rule& rule) {
    if (is_head(rule.head_span))
      text = explain::rule_text(rule, "line " + std::to_string(line_), defines_, 0);
  }
  bool is_head(Span span) const {
    return span.begin <= offset_ && source_.line_of(span.begin) == line_;
  }

  const SourceFile& source_;
  std::uint32_t offset_;
  std::uint32_t line_;
  explain::Defines defines_;
};

}  // namespace

std::string rule_in_english(const Project& project, FileId file, std::uint32_t offset) {
  RuleFinder finder(project, project.sources.file(file), offset);
  for (const ast::Tree* tree : project.trees)
    for (const ast::Item& item : tree->items)
      if (item.span.file == file && item.span.begin <= offset && offset <= item.span.end)
        finder.look(item);
  return std::move(finder.text);
}

}  // namespace robosync::compiler::query
