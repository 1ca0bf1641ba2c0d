// See robot.hpp.
#include "tests/runtime-m4/robot.hpp"

#include <algorithm>
#include <array>
#include <cstdio>

#include <catch2/catch.hpp>

#include "compiler/compiler.hpp"
#include "compiler/diagnostics/render.hpp"
#include "rsc/algorithm_modules.hpp"
#include "tests/runtime-m4/rig.hpp"

namespace robosync::test {

const char* const kPlainRobot = R"({
  "sensors": [
    {"name": "near", "type": "VIRTUAL", "channels": {"X": {"range": [0, 100]}}},
    {"name": "far", "type": "VIRTUAL", "channels": {"Y": {"unit": "%", "range": [0, 100]}}}
  ],
  "actuators": [
    {"name": "a", "type": "VIRTUAL", "device": "virtual_actuator"},
    {"name": "b", "type": "VIRTUAL", "device": "virtual_actuator"},
    {"name": "c", "type": "VIRTUAL", "device": "virtual_actuator"},
    {"name": "d", "type": "VIRTUAL", "device": "virtual_actuator"}
  ],
  "groups": {"bc": ["b", "c"]}
})";

std::string high_and_low(const std::string& high, const std::string& low) {
  return "BEHAVIOR high PRIORITY 20\n" + high + "END\nBEHAVIOR low PRIORITY 10\n" + low + "END\n";
}

std::string rule(const std::string& head, const std::string& body) {
  return head + "\nDO\n" + body + "\nEND\n";
}

std::string when_far(const std::string& body) {
  return rule("WHEN far Y > 50", body);
}

std::string when_near(const std::string& body) {
  return rule("WHEN near X > 10", body);
}

std::string stops_when_far(const std::string& body) {
  return "WHEN near X > 10\nDO\n" + body +
         "\nEND\nSAFETY far\nWHEN near X > 90\nDO STOP ALL\nRESUME WHEN near X < 5\nEND\n";
}

std::vector<std::byte> compile(const std::string& rsl, const std::string& json) {
  const compiler::Result result = compiler::compile({"test.rsl", rsl}, {"test.json", json},
                                                    {.algorithms = tool::algorithm_modules()});
  INFO(compiler::render_human(result.diagnostics, result.sources, false) << rsl);
  REQUIRE_FALSE(result.image.empty());
  return result.image;
}

namespace {

constexpr std::array kParamNames = {
#define PARAM(name, spelling, doc) #name,
#include "vm/params.def"
#undef PARAM
};

std::string number(std::int32_t thousandths) {
  if (thousandths == vm::kUnknown) return "unknown";
  const char* const sign = thousandths < 0 ? "-" : "";
  const std::int64_t size = thousandths < 0 ? -std::int64_t{thousandths} : thousandths;
  std::string text = sign + std::to_string(size / 1000);
  if (size % 1000 != 0) text += "." + std::to_string(1000 + size % 1000).substr(1);
  return text;
}

std::string word_of(const vm::Image& image, std::uint16_t offset) {
  return std::string(image.string(offset));
}

std::string command(const link::Event& event, const vm::Image& image) {
  std::string text = " " + word_of(image, image.actuators[event.subject].name) + " " +
                     word_of(image, image.verbs[event.object].name);
  if (event.values[0] >= 0)
    text += " " + word_of(image, image.words[static_cast<std::size_t>(event.values[0])].name);
  std::size_t next = 2;
  for (unsigned p = 0; p < kParamNames.size(); ++p)
    if ((event.values[1] >> p & 1) != 0)
      text += std::string(" ") + kParamNames[p] + "=" + number(event.values[next++]);
  CHECK(next == event.value_count);
  return text;
}

std::string rule_only(const link::Event& event, const char* name) {
  return std::string(name) + " r" + std::to_string(event.subject);
}

// "mood 2": states and bands by the number of their label.
std::string variable(const link::Event& event, const vm::Image& image) {
  return word_of(image, image.variables[event.subject].name) + " " + number(event.values[0]);
}

std::string text(const link::Event& event, const vm::Image& image) {
  std::string all = "\"" + word_of(image, event.subject) + "\"";
  for (unsigned i = 0; i < event.value_count; ++i)
    all += " " + number(event.values[i]);
  return all;
}

std::string rule(const link::Event& event, const char* name) {
  return std::string(name) + " r" + std::to_string(event.subject) + " " +
         (event.values[0] == 1 ? "DO" : "ELSE");
}

std::string in_the_way(const link::Event& event) {
  return event.object == link::kStop ? "stop" : "b" + std::to_string(event.object);
}

std::string what(const link::Event& event, const vm::Image& image) {
  using link::EventKind;
  const auto actuator = [&] { return word_of(image, image.actuators[event.subject].name); };
  const auto device = [&] {
    return word_of(image, image.sensors[event.subject].name) + " " +
           std::to_string(event.values[0]);
  };
  switch (event.kind) {
    case EventKind::activated:
      return "activated";
    case EventKind::input:
      return "input " + word_of(image, image.channels[event.subject].name) + " " +
             number(event.values[0]);
    case EventKind::stale:
      return "stale " + word_of(image, image.channels[event.subject].name);
    case EventKind::fire:
      return rule(event, "fire");
    case EventKind::win:
      return rule(event, "win");
    case EventKind::lose:
      return rule(event, "lose") + " to " + in_the_way(event);
    case EventKind::interrupt:
      return "interrupt r" + std::to_string(event.subject) + " by " + in_the_way(event);
    case EventKind::command:
      return "command" + command(event, image);
    case EventKind::done:
      return "done " + actuator();
    case EventKind::cancel:
      return "cancel " + actuator();
    case EventKind::overrun:
      return "overrun " + actuator();
    case EventKind::finished:
      return "finished r" + std::to_string(event.subject);
    case EventKind::fault:
      return "fault";
    case EventKind::deadline:
      return "deadline " + std::to_string(event.values[0]);
    case EventKind::set:
      return "set " + variable(event, image);
    case EventKind::wait:
      return rule_only(event, "wait");
    case EventKind::go_on:
      return rule_only(event, "go_on");
    case EventKind::log:
      return "log " + text(event, image);
    case EventKind::alert:
      return "alert " + text(event, image);
    case EventKind::trip:
      return rule_only(event, "trip");
    case EventKind::resume:
      return rule_only(event, "resume");
    case EventKind::halt:
      return "halt " + actuator();
    case EventKind::release:
      return "release " + actuator();
    case EventKind::zero_divide:
      return rule_only(event, "zero_divide");
    case EventKind::priority:
      return "priority b" + std::to_string(event.subject) + " " + std::to_string(event.values[0]);
    case EventKind::lowered:
      return "lowered";
    case EventKind::silent:
      return "silent " + device();
    case EventKind::blocked:
      return "blocked " + actuator();
    case EventKind::answers:
      return "answers " + device();
  }
  return "?";
}

}  // namespace

std::string describe(const link::Event& event, const vm::Image& image) {
  std::string time = std::to_string(event.time_us / 1000);
  if (event.time_us % 1000 != 0) time += "+" + std::to_string(event.time_us % 1000) + "us";
  return time + " #" + std::to_string(event.step) + " " + what(event, image);
}

Robot::Robot(const std::string& rsl, const std::string& json)
    : bytes_(compile(rsl, json)), simulator_(bytes_, [this](const link::Event& event) {
        if (image_.header == nullptr) REQUIRE(vm::view_image(bytes_, image_));
        lines_.push_back(describe(event, image_));
      }) {
  INFO(vm::describe(simulator_.verdict().refusal));
  REQUIRE(simulator_.verdict().ok());
}

bool Robot::has(std::string_view channel) const {
  return std::any_of(image_.channels.begin(), image_.channels.end(),
                     [&](const vm::Channel& c) { return image_.string(c.name) == channel; });
}

void Robot::feed(std::uint64_t at_ms, std::string_view channel, int units) {
  feed_raw(at_ms, channel, units * vm::kScale);
}

void Robot::feed_raw(std::uint64_t at_ms, std::string_view channel, vm::Value thousandths) {
  for (std::size_t c = 0; c < image_.channels.size(); ++c)
    if (image_.string(image_.channels[c].name) == channel)
      return simulator_.feed(at_ms * 1000, static_cast<std::uint8_t>(c), thousandths);
  FAIL("no channel " << channel);
}

std::string Robot::trace() const {
  std::string all;
  for (const std::string& line : lines_)
    all += line + "\n";
  return all;
}

std::string Robot::only(std::string_view events) const {
  return select(lines_, events);
}

}  // namespace robosync::test
