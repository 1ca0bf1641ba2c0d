// The full screen of rsc monitor: what the model makes of events, and how it is laid out; how a terminal shows it is
// tests/e2e/test_monitor.py's part.
#include <algorithm>

#include <catch2/catch.hpp>

#include "rsc/screen/layout.hpp"
#include "rsc/screen/model.hpp"
#include "tests/rsc/image.hpp"

using namespace robosync;
using Catch::Contains;
using link::EventKind;
namespace screen = tool::screen;

namespace {

constexpr const char* kWatched = R"(CHECK feel OF touch LEVEL
  light BELOW 4
  firm OTHERWISE
END
STATE mood: calm, cross
BEHAVIOR strong PRIORITY 80
WHEN touch LEVEL > 6 DO
  MOVE left_arm SLOWLY TO 90deg
  SET mood TO cross
END
END
BEHAVIOR weak PRIORITY 20
WHEN touch LEVEL < 3 DO
  MOVE left_arm QUICKLY TO 0deg
END
END
)";

struct Watched {
  Watched() { model.program(names, program.bytes()); }

  void event(EventKind kind, std::uint64_t ms, std::uint16_t subject,
             std::vector<std::int32_t> values = {}, std::uint16_t object = 0) {
    link::Event event;
    event.kind = kind;
    event.time_us = ms * 1000;
    event.subject = subject;
    event.object = object;
    event.value_count = static_cast<std::uint8_t>(values.size());
    std::ranges::copy(values, event.values.begin());
    model.event(event, names);
  }
  [[nodiscard]] std::string text(const screen::View& view = {}, std::size_t rows = 40,
                                 std::size_t columns = 120) const {
    std::string all;
    for (const screen::Line& line : screen::lay_out(model, view, rows, columns)) {
      for (const screen::Piece& piece : line)
        all += piece.text;
      all += '\n';
    }
    return all;
  }
  // Behaviours stand in the image by priority; so do their rules.
  [[nodiscard]] std::uint16_t rule_of(const std::string& behavior) const {
    for (const vm::Behavior& one : program.image().behaviors)
      if (one.name != vm::kNoIndex && program.image().string(one.name) == behavior)
        return one.first_rule;
    FAIL("no behaviour " << behavior);
    return 0;
  }
  [[nodiscard]] std::uint16_t number_of(const std::string& behavior) const {
    std::uint16_t number = 0;
    for (const vm::Behavior& one : program.image().behaviors) {
      if (one.name != vm::kNoIndex && program.image().string(one.name) == behavior) return number;
      ++number;
    }
    FAIL("no behaviour " << behavior);
    return 0;
  }
  [[nodiscard]] const screen::BehaviorRow& behavior(const std::string& name) const {
    return *std::ranges::find(model.behaviors(), name, &screen::BehaviorRow::name);
  }

  tool::Program program = test::compile(kWatched);
  tool::TraceNames names{&program.image(), {}, nullptr};
  screen::Model model;
};

}  // namespace

TEST_CASE("the screen's model knows who has an actuator, and who was denied it") {
  Watched robot;
  CHECK(robot.model.actuators().at(0).owner.empty());
  robot.event(EventKind::win, 100, robot.rule_of("strong"), {1});
  CHECK(robot.model.actuators().at(0).owner == "strong");
  CHECK(robot.behavior("strong").state == "running");
  robot.event(EventKind::command, 100, 0, {-1, 0});
  CHECK_FALSE(robot.model.actuators().at(0).command.empty());
  robot.event(EventKind::lose, 200, robot.rule_of("weak"), {1}, robot.number_of("strong"));
  CHECK(robot.model.actuators().at(0).denied == "weak");
  CHECK_THAT(robot.behavior("weak").denied, Contains("0.200 s by") && Contains("strong"));
  CHECK_THAT(robot.text(), Contains("denied to weak"));
  robot.event(EventKind::wait, 300, robot.rule_of("strong"));
  CHECK(robot.behavior("strong").state == "waiting");
  robot.event(EventKind::done, 400, 0);
  CHECK(robot.model.actuators().at(0).command.empty());
  robot.event(EventKind::finished, 400, robot.rule_of("strong"));
  CHECK(robot.model.actuators().at(0).owner.empty());
  CHECK(robot.behavior("strong").state.empty());

  robot.event(EventKind::priority, 500, robot.number_of("weak"), {35});
  CHECK_THAT(robot.text(), Contains("20+15"));
  robot.event(EventKind::halt, 600, 0);
  CHECK_THAT(robot.text(), Contains("HALTED"));
  robot.event(EventKind::release, 700, 0);
  CHECK_THAT(robot.text(), !Contains("HALTED"));
}

TEST_CASE("the screen's model knows values, bands and their past") {
  Watched robot;
  CHECK(robot.model.sensors().at(0).value == "unknown");
  robot.event(EventKind::input, 1000, 0, {2000});
  robot.event(EventKind::input, 2000, 0, {9000});
  const auto& touch = robot.model.sensors().at(0);
  CHECK(touch.name == "touch.LEVEL");
  CHECK(touch.value == "9");
  // Seconds 0 to 4 at the ends of five columns.
  CHECK(screen::sparkline(touch, 4'000'000, 5'000'000, 5, false) == " _###");
  CHECK(screen::sparkline(touch, 4'000'000, 5'000'000, 5, true) == " ▁███");
  robot.event(EventKind::stale, 3000, 0);
  CHECK(touch.value == "unknown");
  CHECK(screen::sparkline(touch, 4'000'000, 5'000'000, 5, false) == " _#  ");
  const auto& variables = robot.program.image().variables;
  for (std::uint16_t v = 0; v < variables.size(); ++v)
    robot.event(EventKind::set, 3000, v, {1000});
  CHECK(touch.band == "firm");
  CHECK(robot.model.variables() ==
        std::vector<std::pair<std::string, std::string>>{{"mood", "cross"}});
  // What is older than the window is forgotten, not what it begins with.
  for (std::uint64_t s = 4; s < 200; ++s)
    robot.event(EventKind::input, s * 1000, 0, {static_cast<std::int32_t>(s % 9) * 1000});
  CHECK(touch.history.size() <= 63);
}

TEST_CASE("the screen's model begins with what the board says of now") {
  Watched robot;
  const auto told = [](EventKind kind, std::vector<std::int32_t> values = {}) {
    link::Event event;
    event.kind = kind;
    event.value_count = static_cast<std::uint8_t>(values.size());
    std::ranges::copy(values, event.values.begin());
    return event;
  };
  tool::Current now{
      .stopped = true,
      .events = {told(EventKind::input, {9000}), told(EventKind::trip), told(EventKind::halt)}};
  robot.model.current(now, robot.names);
  CHECK(robot.model.sensors().at(0).value == "9");
  CHECK_THAT(robot.text(), Contains("is tripped") && Contains("HALTED") &&
                               Contains("stopped by a person") && !Contains("nothing is tripped"));
  CHECK(robot.model.log().empty());
  robot.event(EventKind::trip, 1000, 0);  // told again by an event that was under way
  CHECK(robot.model.trips().size() == 1);
  robot.model.current({}, robot.names);
  CHECK_THAT(robot.text(), !Contains("HALTED") && Contains("nothing is tripped"));
}

TEST_CASE("a screen has as many lines as the terminal, none too wide, whatever its size") {
  Watched robot;
  for (int i = 0; i < 50; ++i)
    robot.model.say("line " + std::to_string(i));
  robot.model.say("\x1b[31mevil\x07\xc2\x9b\xff tail");
  for (const std::size_t rows : {1U, 2U, 5U, 9U, 24U, 60U})
    for (const std::size_t columns : {1U, 10U, 40U, 80U, 300U}) {
      const auto lines = screen::lay_out(robot.model, {}, rows, columns);
      CHECK(lines.size() == rows);
      for (const screen::Line& line : lines) {
        std::string all;
        for (const screen::Piece& piece : line)
          all += piece.text;
        CHECK(screen::fitted(all, columns) == all);  // nothing to cut, nothing that controls
      }
    }
  CHECK_THAT(robot.text(), Contains("?[31mevil???? tail"));
  CHECK_THAT(robot.text({}, 14), Contains("more)") && Contains("LOG") && Contains("line 49"));
  screen::View view;
  view.filter = "WEAK";
  CHECK_THAT(robot.text(view),
             Contains("weak") && !Contains("strong ") && !Contains("touch.LEVEL"));
  view = {};
  view.lost = true;
  view.prompt = "reading: ";
  CHECK_THAT(robot.text(view),
             Contains("LINE LOST") && Contains("reading: ") && !Contains("q quit"));
  CHECK(screen::fitted("grün", 3) == "grü");
}

TEST_CASE("the screen's model takes events of numbers that no image has") {
  Watched robot;
  for (int kind = 1; kind < 29; ++kind)
    for (const std::uint16_t number :
         {std::uint16_t{0}, std::uint16_t{200}, std::uint16_t{65535}}) {
      robot.event(static_cast<EventKind>(kind), 10, number, {}, number);
      robot.event(static_cast<EventKind>(kind), 10, number, {INT32_MIN, INT32_MAX}, number);
    }
  CHECK_FALSE(robot.text().empty());
  robot.model.program({}, {});  // no program runs any more
  robot.names.image = nullptr;
  robot.event(EventKind::command, 20, 0, {});
  CHECK_THAT(robot.text(), Contains("no program"));
}
