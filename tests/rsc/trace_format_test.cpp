// Trace events as JSON and as words; and with numbers that the image does not have.
#include "rsc/trace/trace_format.hpp"

#include <random>

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "tests/rsc/image.hpp"
#include "vm/opcode.hpp"

using namespace robosync;
using link::Event;
using link::EventKind;
using nlohmann::json;

namespace {

const tool::Program& program() {
  static const tool::Program compiled = test::compile();
  return compiled;
}

Event event(EventKind kind, std::uint16_t subject = 0, std::uint16_t object = 0,
            std::vector<std::int32_t> values = {}) {
  Event result{1'020'000, 7, kind, static_cast<std::uint8_t>(values.size()), subject, object, {}};
  std::ranges::copy(values, result.values.begin());
  return result;
}

link::ThreadInfo thread(std::string_view name, std::uint8_t category) {
  link::ThreadInfo thread{};
  std::ranges::copy(name, thread.name.begin());
  thread.category = category;
  return thread;
}

tool::TraceNames names() {
  return {&program().image(),
          {thread("safety", 6), thread("step", 3), thread("shy", 4), thread("rule", 4),
           thread("arm", 5), thread("touch", 1), thread("own", 2), thread("wild", 77)}};
}
json as_json(const Event& event) {
  return json::parse(tool::trace_json(event, names()));
}
std::string as_words(const Event& event) {
  return tool::trace_line(event, names());
}

}  // namespace

TEST_CASE("an input has sensor, channel, value and unit") {
  CHECK(as_json(event(EventKind::input, 0, 0, {2000})) ==
        json::parse(R"({"t_us":1020000,"step":7,"event":"input","sensor":"touch",
                        "channel":"LEVEL","value":2})"));
  CHECK(as_words(event(EventKind::input, 0, 0, {2000})) == "   1.020 s  touch LEVEL = 2");
  const json distance = as_json(event(EventKind::input, 1, 0, {205'500}));
  CHECK(distance.at("value") == 205.5);
  CHECK(distance.at("unit") == "mm");
  CHECK(as_json(event(EventKind::input, 0, 0, {vm::kUnknown})).at("value").is_null());
}

TEST_CASE("rules are named by their line and behaviour") {
  const auto& behaviors = program().image().behaviors;
  const auto named = static_cast<std::uint16_t>(behaviors[0].name == vm::kNoIndex ? 1 : 0);
  const auto rule_of = [&](std::size_t at) { return behaviors[at].first_rule; };
  const auto plain = static_cast<std::uint16_t>(1 - named);

  const json fire = as_json(event(EventKind::fire, rule_of(named), 0, {1}));
  CHECK(fire.at("line") == 5);
  CHECK(fire.at("behavior") == "shy");
  CHECK(fire.at("side") == "DO");
  CHECK(as_words(event(EventKind::fire, rule_of(plain), 0, {1})) ==
        "   1.020 s  rule at line 1 triggers");
  CHECK_FALSE(as_json(event(EventKind::fire, rule_of(plain), 0, {0})).contains("behavior"));
  CHECK(as_words(event(EventKind::lose, rule_of(plain), named, {1})) ==
        "   1.020 s  rule at line 1 does not start: behaviour shy has an actuator it "
        "needs");
  CHECK(as_words(event(EventKind::lose, rule_of(plain), plain, {1})) ==
        "   1.020 s  rule at line 1 does not start: its response is still running");
  CHECK(as_words(event(EventKind::interrupt, rule_of(plain), plain)) ==
        "   1.020 s  rule at line 1 gives up what it was doing");
  CHECK(as_json(event(EventKind::interrupt, rule_of(named), plain)).at("by") ==
        "the rule at line 1");
  CHECK(as_words(event(EventKind::lose, rule_of(plain), link::kStop, {1})) ==
        "   1.020 s  rule at line 1 does not start: the robot is stopped");
  CHECK(as_words(event(EventKind::interrupt, rule_of(plain), link::kStop)) ==
        "   1.020 s  rule at line 1 is interrupted by a person's stop");
  CHECK(as_json(event(EventKind::interrupt, rule_of(named), link::kStop)).at("by") ==
        "a person's stop");
}

TEST_CASE("commands have verb, word and the parameters that were given") {
  const vm::Image& image = program().image();
  std::int32_t slowly = -1;
  for (std::size_t i = 0; i < image.words.size(); ++i) {
    if (image.string(image.words[i].name) == "SLOWLY") slowly = static_cast<std::int32_t>(i);
  }
  REQUIRE(slowly >= 0);
  // TO (bit 0) and OVER (bit 3).
  const Event command = event(EventKind::command, 0, 0, {slowly, 0b1001, 90'000, 2500});
  const json object = as_json(command);
  CHECK(object.at("actuator") == "left_arm");
  CHECK(object.at("word") == "SLOWLY");
  CHECK(object.at("to") == 90);
  CHECK(object.at("over") == 2.5);
  CHECK_FALSE(object.contains("at"));
  const std::string verb = object.at("verb");
  CHECK(as_words(command) == "   1.020 s  left_arm " + verb + " SLOWLY TO 90 OVER 2.5s");
}

namespace {

// A program that remembers; its image has labels, texts and safety rules.
const tool::Program& remembering() {
  static const tool::Program compiled = test::compile(R"(STATE mood: calm, very scared
FEELING joy FROM 0% TO 100% START 50%
TIMER idle
SAFETY guard
  WHEN touch LEVEL > 9
  DO ALERT "too hard"
  RESUME WHEN touch LEVEL < 1
END
WHEN touch LEVEL > 3 DO
  SET mood TO very scared
  RESTART idle
  RAISE joy BY 5%
  LOG "touched with", touch LEVEL, "by hand"
END
WHEN mood IS calm AND joy > 70% DO
  MOVE left_arm
END
)");
  return compiled;
}

std::uint16_t variable(std::string_view name) {
  const vm::Image& image = remembering().image();
  for (std::size_t i = 0; i < image.variables.size(); ++i) {
    if (image.string(image.variables[i].name) == name) return static_cast<std::uint16_t>(i);
  }
  FAIL("no variable " << name);
  return 0;
}

// The text that an instruction of this kind has.
std::uint16_t text_of(vm::Opcode opcode) {
  for (const vm::Word word : remembering().image().code) {
    if ((word & 0xFF) == static_cast<vm::Word>(opcode)) {
      return static_cast<std::uint16_t>(word >> 16);
    }
  }
  FAIL("no such instruction");
  return 0;
}

std::string remembered(const Event& event) {
  return tool::trace_words(event, {&remembering().image(), {}});
}
json remembered_json(const Event& event) {
  return json::parse(tool::trace_json(event, {&remembering().image(), {}}));
}

}  // namespace

TEST_CASE("what is remembered is shown as its label, or with its unit") {
  const Event scared = event(EventKind::set, variable("mood"), 0, {1000});
  CHECK(remembered(scared) == "mood becomes very scared");
  CHECK(remembered_json(scared).at("variable") == "mood");
  CHECK(remembered_json(scared).at("value") == "very scared");
  const Event joy = event(EventKind::set, variable("joy"), 0, {55'500});
  CHECK(remembered(joy) == "joy becomes 55.5%");
  CHECK(remembered_json(joy).at("value") == 55.5);
  CHECK(remembered_json(joy).at("unit") == "%");
  // No label has these numbers.
  CHECK(remembered(event(EventKind::set, variable("mood"), 0, {2000})) == "mood becomes 2");
  CHECK(remembered(event(EventKind::set, variable("mood"), 0, {1500})) == "mood becomes 1.5");
  CHECK(remembered(event(EventKind::set, variable("mood"), 0, {vm::kUnknown})) ==
        "mood becomes unknown");
}

TEST_CASE("a TIMER that is restarted is at 0, whenever that was") {
  const Event restart = event(EventKind::set, variable("idle"), 0, {7000});
  CHECK(remembered(restart) == "idle is restarted");
  CHECK(remembered_json(restart).at("value") == 0);
}

TEST_CASE("LOG and ALERT: the text, with the values in its places") {
  const Event log = event(EventKind::log, text_of(vm::Opcode::log), 0, {2500});
  CHECK_THAT(remembered(log), Catch::StartsWith("log: touched with") && Catch::Contains("2.5") &&
                                  Catch::EndsWith("by hand") && !Catch::Contains("{}"));
  CHECK_THAT(remembered_json(log).at("text").get<std::string>(), Catch::Contains("2.5"));
  CHECK(remembered_json(log).at("values") == json::array({2.5}));
  // One that lost its values keeps its places; one with too many shows what has a place.
  CHECK_THAT(remembered(event(EventKind::log, text_of(vm::Opcode::log))), Catch::Contains("{}"));
  CHECK(remembered(event(EventKind::log, text_of(vm::Opcode::log), 0, {2500, 3000, 4000})) ==
        remembered(log));
  const Event alert = event(EventKind::alert, text_of(vm::Opcode::alert));
  CHECK(remembered(alert) == "ALERT: too hard");
  CHECK(remembered_json(alert).at("text") == "too hard");
}

TEST_CASE("safety and waits in words") {
  const vm::Image& image = remembering().image();
  REQUIRE(image.behaviors[0].priority == vm::kSafetyPriority);
  const std::uint16_t guard = image.behaviors[0].first_rule;
  CHECK(remembered(event(EventKind::trip, guard)) == "SAFETY: safety rule at line 4 trips");
  CHECK(remembered(event(EventKind::resume, guard)) == "SAFETY: safety rule at line 4 lets go");
  const auto named = [&](std::string name) {
    tool::Origin origin;
    origin.safety.resize(image.rules.size());
    origin.safety[guard] = std::move(name);
    return tool::trace_line(event(EventKind::trip, guard), {&image, {}, &origin});
  };
  CHECK_THAT(named("pinched"), Catch::EndsWith("SAFETY: safety rule pinched at line 4 trips"));
  CHECK_THAT(named(""), Catch::EndsWith("SAFETY: safety rule at line 4 trips"));
  const std::uint16_t rule = image.behaviors[1].first_rule;
  CHECK_THAT(remembered(event(EventKind::wait, rule)), Catch::EndsWith(" waits"));
  CHECK_THAT(remembered(event(EventKind::go_on, rule)), Catch::EndsWith(" goes on"));
  CHECK_THAT(remembered(event(EventKind::zero_divide, rule)), Catch::Contains("divided by zero"));
  CHECK(remembered(event(EventKind::halt, 0)) == "left_arm is halted");
  CHECK(remembered(event(EventKind::release, 0)) == "left_arm may move again");
  CHECK_THAT(remembered(event(EventKind::lose, rule, 0, {1})),
             Catch::EndsWith("safety has an actuator it needs"));
}

TEST_CASE("a priority that changes is told beside the one that is written") {
  const auto& behaviors = program().image().behaviors;
  const auto named = static_cast<std::uint16_t>(behaviors[0].name == vm::kNoIndex ? 1 : 0);
  const std::int32_t base = behaviors[named].priority;
  const std::string written = std::to_string(base);
  const json raised = as_json(event(EventKind::priority, named, 0, {base + 7}));
  CHECK(raised.at("behavior") == "behaviour shy");
  CHECK(raised.at("priority") == base + 7);
  CHECK(raised.at("base") == base);
  CHECK_THAT(as_words(event(EventKind::priority, named, 0, {base + 7})),
             Catch::EndsWith("behaviour shy has priority " + std::to_string(base + 7) +
                             " now, in place of " + written));
  CHECK_THAT(as_words(event(EventKind::priority, named, 0, {base})),
             Catch::EndsWith("behaviour shy has its priority of " + written + " back"));
}

TEST_CASE("threads have their names") {
  CHECK(as_words(event(EventKind::deadline, 1, 0, {1500})) ==
        "   1.020 s  step is late by 1500 us");
  CHECK(as_json(event(EventKind::fault, 9)).at("thread") == "thread 9");
  CHECK(as_json(event(EventKind::fault, 2)).at("thread") == "shy");
  for (const auto& [rank, whose] : {std::pair(2, "behaviour shy"),
                                    {3, "a rule outside a BEHAVIOR"},
                                    {4, "actuator arm"},
                                    {5, "sensor touch"},
                                    {6, "algorithm own"},
                                    {7, "wild"},
                                    {8, "thread 8"}})
    CHECK_THAT(as_words(event(EventKind::fault, static_cast<std::uint16_t>(rank))),
               Catch::EndsWith(std::string(whose) + " is stopped by a fault"));
}

TEST_CASE("any event of any image is shown, whatever its numbers") {
  std::mt19937 random(11);
  for (int i = 0; i < 20'000; ++i) {
    Event wild;
    wild.kind = static_cast<EventKind>(random() % 256);
    if (!link::known(wild.kind)) continue;
    wild.time_us = random();
    wild.value_count = static_cast<std::uint8_t>(random() % (link::kMaxEventValues + 1));
    wild.subject = static_cast<std::uint16_t>(random() % 2 == 0 ? random() % 4 : random());
    wild.object = static_cast<std::uint16_t>(random() % 2 == 0 ? random() % 4 : random());
    for (std::int32_t& value : wild.values)
      value = static_cast<std::int32_t>(random());
    for (const vm::Image* image : {&program().image(), static_cast<const vm::Image*>(nullptr)}) {
      REQUIRE(json::parse(tool::trace_json(wild, {image, {}})).contains("event"));
      REQUIRE_FALSE(tool::trace_line(wild, {image, {}}).empty());
    }
  }
}

TEST_CASE("a sensor that hears no echo is told of with its pins") {
  const std::string robot = R"({"sensors": [
    {"name": "sonar", "type": "GPIO", "trigger": 3, "echo": 40, "device": "hc-sr04"}]})";
  const compiler::Result result = compiler::compile(
      {"robot.rsl", "WHEN sonar DISTANCE < 20cm DO LOG \"near\" END\n"}, {"robot.json", robot});
  REQUIRE_FALSE(result.image.empty());
  const tool::Program sonar{result.image, "robot.rsl", tool::board_memory(), {}};
  const auto line = [&](EventKind kind) {
    return tool::trace_line(event(kind, 0, 0, {3}), {&sonar.image(), {}});
  };
  CHECK(line(EventKind::silent) ==
        "   1.020 s  sonar, trigger 3 and echo 40, hears no echo (3 times without one so far)");
  CHECK_THAT(line(EventKind::answers), Catch::Contains("hears an echo again (3 times"));
  const json told =
      json::parse(tool::trace_json(event(EventKind::silent, 0, 0, {3}), {&sonar.image(), {}}));
  CHECK((told.at("trigger") == 3 && told.at("echo") == 40));
  CHECK_FALSE(told.contains("address"));
}

TEST_CASE("a sensor that sees nothing is told of with its place on the bus") {
  const std::string robot = R"({"sensors": [
    {"name": "front", "type": "I2C", "address": "0x29", "device": "vl53l0x"}]})";
  const compiler::Result result = compiler::compile(
      {"robot.rsl", "WHEN front DISTANCE < 20cm DO LOG \"near\" END\n"}, {"robot.json", robot});
  REQUIRE_FALSE(result.image.empty());
  const tool::Program front{result.image, "robot.rsl", tool::board_memory(), {}};
  const auto line = [&](EventKind kind) {
    return tool::trace_line(event(kind, 0, 0, {3}), {&front.image(), {}});
  };
  CHECK_THAT(line(EventKind::silent),
             Catch::Contains("front") && Catch::Contains("0x29") &&
                 Catch::EndsWith(" sees nothing (3 times without a distance so far)"));
  CHECK_THAT(line(EventKind::answers), Catch::Contains("sees something again (3 times"));
}

TEST_CASE("a sensor whose voltage is not measured is told of with its pin") {
  const compiler::Result result = compiler::compile(
      {"robot.rsl", "WHEN grip FORCE > 20% DO LOG \"held\" END\n"},
      {"robot.json",
       R"({"sensors": [{"name": "grip", "type": "ADC", "pin": 45, "device": "force"}]})"});
  REQUIRE_FALSE(result.image.empty());
  const tool::Program grip{result.image, "robot.rsl", tool::board_memory(), {}};
  const auto line = [&](EventKind kind) {
    return tool::trace_line(event(kind, 0, 0, {3}), {&grip.image(), {}});
  };
  CHECK(line(EventKind::silent) ==
        "   1.020 s  grip on analog pin 45 is not measured (3 times without a voltage so far)");
  CHECK_THAT(line(EventKind::answers), Catch::Contains("is measured again (3 times"));
  const json told =
      json::parse(tool::trace_json(event(EventKind::silent, 0, 0, {3}), {&grip.image(), {}}));
  CHECK(told.at("pin") == 45);
  CHECK_FALSE((told.contains("address") || told.contains("bus")));
}

TEST_CASE("a part on SPI that does not answer is told of with its bus and its select pin") {
  const compiler::Result result = compiler::compile(
      {"robot.rsl", "WHEN knob LEVEL > 20% DO LOG \"up\" END\n"},
      {"robot.json", R"({"sensors": [{"name": "knob", "device": "mcp3008", "pin": 37}]})"});
  REQUIRE_FALSE(result.image.empty());
  const tool::Program knob{result.image, "robot.rsl", tool::board_memory(), {}};
  CHECK(
      tool::trace_line(event(EventKind::silent, 0, 0, {3}), {&knob.image(), {}}) ==
      "   1.020 s  knob on spi bus 0, select pin 37, does not answer (3 failed transfers so far)");
  const json told =
      json::parse(tool::trace_json(event(EventKind::silent, 0, 0, {3}), {&knob.image(), {}}));
  CHECK((told.at("bus") == 0 && told.at("pin") == 37 && !told.contains("address")));
}

TEST_CASE("a microphone that hears nothing is told of without a place") {
  const compiler::Result result = compiler::compile(
      {"robot.rsl", "WHEN ear LOUDNESS > 60dB DO LOG \"loud\" END\n"},
      {"robot.json",
       R"({"board": "microbit-v2", "sensors": [{"name": "ear", "device": "microphone"}]})"});
  REQUIRE_FALSE(result.image.empty());
  const tool::Program ear{result.image, "robot.rsl", tool::board_memory(), {}};
  const auto line = [&](EventKind kind) {
    return tool::trace_line(event(kind, 0, 0, {3}), {&ear.image(), {}});
  };
  CHECK(line(EventKind::silent) == "   1.020 s  ear hears nothing (3 times without sound so far)");
  CHECK_THAT(line(EventKind::answers), Catch::Contains("ear hears again (3 times"));
  const json told =
      json::parse(tool::trace_json(event(EventKind::silent, 0, 0, {3}), {&ear.image(), {}}));
  CHECK_FALSE((told.contains("address") || told.contains("bus")));
}

TEST_CASE("a device on a bus is told of with where it is; without an image by its number") {
  const Event silent = event(EventKind::silent, 1, 0, {3});
  CHECK(as_json(silent) ==
        json::parse(R"({"t_us":1020000,"step":7,"event":"silent","sensor":"proximity",
                                           "bus":0,"address":"0x00","failed":3})"));
  CHECK(as_words(silent) ==
        "   1.020 s  proximity at address 0x00 on i2c bus 0 does not answer (3 failed transfers so "
        "far)");
  const Event answers = event(EventKind::answers, 1, 0, {8});
  CHECK_THAT(as_words(answers), Catch::Contains("answers again (8 failed transfers so far)"));
  CHECK(tool::trace_line(answers, {}) ==
        "   1.020 s  sensor 1 answers again (8 failed transfers so far)");
  CHECK(
      json::parse(tool::trace_json(answers, {})) ==
      json::parse(R"({"t_us":1020000,"step":7,"event":"answers","sensor":"sensor 1","failed":8})"));
}

TEST_CASE("how fast a MOTION is performed is a share, whatever unit its actuators' speed has") {
  const tool::Program motion = test::compile(
      "MOTION wave OF left_arm\n  AT 300ms 90deg\nEND\nWHEN touch LEVEL > 3\nDO PERFORM wave AT "
      "150%\nEND\n");
  const auto at = 1 << static_cast<unsigned>(vm::Param::at);
  const Event command = event(EventKind::command, 0, 0, {0, at, 150'000});
  CHECK(tool::trace_words(command, {&motion.image(), {}, &motion.origin()}) ==
        "left_arm PERFORM wave AT 150%");
}
