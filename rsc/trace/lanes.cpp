// See lanes.hpp. Reads what trace_json.cpp writes, by key; missing keys are empty.
#include "rsc/trace/lanes.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <string_view>

#include <fmt/format.h>

namespace robosync::tool {
namespace {

constexpr std::array<std::string_view, kLaneGroups> kLaneNames = {
    "robot", "safety", "behaviors", "actuators", "variables", "sensors"};
constexpr const char* kProgram = "program";

std::string name_of_rule(const TraceLine& line) {
  const std::string behavior = line.text("behavior"), place = line.text("line");
  const std::string rule = place.empty() ? "rule " + line.text("rule") : "line " + place;
  return behavior.empty() ? rule : behavior + ", " + rule;
}

// "MOVE SLOWLY TO 90": the verb, its word, its parameters.
std::string command_text(const TraceLine& line) {
  std::string text = line.text("verb");
  if (const std::string word = line.text("word"); !word.empty()) text += " " + word;
  bool is_param = false;  // they follow the verb
  for (const auto& [key, value] : line.event.items()) {
    if (is_param && key != "word") {
      std::string name = key;
      std::ranges::transform(name, name.begin(), [](unsigned char c) { return std::toupper(c); });
      text += fmt::format(" {} {}", name, json_text(value));
    }
    is_param = is_param || key == "verb";
  }
  return text;
}

// The text of a message besides its kind.
std::string message_text(const TraceLine& line) {
  std::string text;
  for (const char* key : {"text", "thread", "actuator", "sensor", "late_us", "failed"})
    if (const std::string part = line.text(key); !part.empty())
      text += (text.empty() ? "" : " ") + part;
  if (line.event.contains("rule")) text += name_of_rule(line);
  return text;
}

bool is_one_of(std::string_view kind, std::initializer_list<std::string_view> kinds) {
  return std::ranges::find(kinds, kind) != kinds.end();
}

}  // namespace

std::string_view name_of(LaneGroup group) {
  return kLaneNames.at(static_cast<std::size_t>(group));
}

Lane& Lanes::lane(LaneGroup group, const std::string& name) {
  const auto [found, is_new] = lane_of_.try_emplace({group, name}, lanes_.size());
  if (is_new) lanes_.push_back({group, name, {}, {}});
  return lanes_[found->second];
}

void Lanes::begin(LaneGroup group, const std::string& name, const std::string& text) {
  end(group, name);
  lane(group, name).spans.push_back({end_us_, end_us_, text});
  goes_on_[{group, name}] = true;
}

void Lanes::end(LaneGroup group, const std::string& name) {
  bool& goes_on = goes_on_[{group, name}];
  if (goes_on) lane(group, name).spans.back().to_us = end_us_;
  goes_on = false;
}

void Lanes::end_all() {
  for (const auto& [which, goes_on] : goes_on_)
    if (goes_on) end(which.first, which.second);
}

void Lanes::mark(LaneGroup group, const std::string& name, const std::string& text) {
  lane(group, name).moments.push_back({end_us_, text});
}

void Lanes::see(const TraceLine& line) {
  end_us_ = line.at_us;
  const std::string kind = line.text("event");
  if (kind == "activated") {
    end_all();
    begin(LaneGroup::robot, kProgram, fmt::format("program {}", line.program));
  } else if (is_one_of(kind, {"log", "alert", "fault", "deadline", "lowered", "overrun",
                              "zero_divide", "silent", "answers", "blocked"})) {
    mark(LaneGroup::robot, kind, message_text(line));
  } else if (line.event.contains("rule")) {
    see_rule(line, kind);
  } else if (line.event.contains("actuator")) {
    see_actuator(line, kind);
  } else if (is_one_of(kind, {"input", "stale", "set"})) {
    see_value(line, kind);
  }
}

void Lanes::see_rule(const TraceLine& line, const std::string& kind) {
  const std::string name = name_of_rule(line);
  if (kind == "win")
    begin(LaneGroup::behaviors, name, line.text("side"));
  else if (kind == "finished" || kind == "interrupt")
    end(LaneGroup::behaviors, name);
  else if (kind == "lose")
    mark(LaneGroup::behaviors, name, "denied by " + line.text("by"));
  else if (kind == "trip")
    begin(LaneGroup::safety, name, "tripped");
  else if (kind == "resume")
    end(LaneGroup::safety, name);
}

void Lanes::see_actuator(const TraceLine& line, const std::string& kind) {
  const std::string name = line.text("actuator");
  if (kind == "command") {
    begin(LaneGroup::actuators, name, command_text(line));
    return;
  }
  if (is_one_of(kind, {"done", "cancel", "halt"})) end(LaneGroup::actuators, name);
  if (kind == "halt") begin(LaneGroup::safety, name, "halted");
  if (kind == "release") end(LaneGroup::safety, name);
}

void Lanes::see_value(const TraceLine& line, const std::string& kind) {
  const bool is_variable = kind == "set";
  const LaneGroup group = is_variable ? LaneGroup::variables : LaneGroup::sensors;
  const std::string name =
      is_variable ? line.text("variable") : line.text("sensor") + "." + line.text("channel");
  const auto [found, is_new] = curve_of_.try_emplace({group, name}, curves_.size());
  if (is_new) curves_.push_back({group, name, {}, false, {}});
  Curve& curve = curves_[found->second];
  if (curve.unit.empty()) curve.unit = line.text("unit");
  Sample sample{end_us_, std::nullopt, {}};
  const auto value = line.event.find("value");
  if (value != line.event.end() && value->is_number()) sample.number = value->get<double>();
  if (value != line.event.end() && value->is_string()) sample.word = value->get<std::string>();
  curve.has_words = curve.has_words || !sample.word.empty();
  curve.samples.push_back(std::move(sample));
}

void Lanes::finish() {
  end_all();
}

}  // namespace robosync::tool
