// What programs become: instructions, sections, sizes; and that the same input gives the same
// bytes.
#include <string>
#include <utility>

#include <catch2/catch.hpp>

#include "tests/compiler/compiled.hpp"
#include "vm/arithmetic.hpp"
#include "vm/interpreter.hpp"

using namespace robosync;
using namespace robosync::compiler;
using namespace robosync::compiler::testing;
namespace fs = std::filesystem;

namespace {

Result example(const std::string& name, bool source_lines = false) {
  const fs::path folder = source_folder() / "examples" / name;
  return compile_text(read_file(folder / "robot.rsl"), read_file(folder / "robot.json"),
                      source_lines);
}

Result common(const std::string& program, bool source_lines = false) {
  Result result = compile_text(program, common_robot(), source_lines);
  INFO(messages(result));
  REQUIRE(!result.image.empty());
  return result;
}

std::string rule(const std::string& condition, const std::string& body = "MOVE left_arm SLOWLY") {
  return "WHEN " + condition + "\nDO\n" + body + "\nEND\n";
}

// What the condition of the only rule comes to for these inputs (thousandths).
vm::Value evaluate(const Result& result, std::vector<vm::Value> frame) {
  const vm::Image image = view(result);
  REQUIRE(image.rules.size() == 1);
  frame.resize(vm::kMaxCells, vm::kUnknown);
  vm::Machine machine;
  machine.frame = frame.data();
  machine.constants = image.constants.data();
  return vm::evaluate(machine, image.code.data() + image.rules[0].condition_start);
}

}  // namespace

TEST_CASE("the paper's program fits its bars") {
  const Result result = example("touch_companion");
  INFO(messages(result));
  REQUIRE(!result.image.empty());
  CHECK(result.image.size() <= 400);
  const vm::Image image = view(result);
  REQUIRE(image.rules.size() == 1);
  CHECK(image.code.size_bytes() + image.constants.size_bytes() <= 34);
  CHECK(image.actuators.size() == 3);
  CHECK(image.groups.size() == 1);
  CHECK(image.channels[0].stale_ms == 100);
  CHECK(image.sensors[0].period_ms == 20);
  CHECK(image.sensors[0].address == 0x70);
}

TEST_CASE("the examples become these instructions", "[golden]") {
  for (const char* name : {"touch_companion", "paper"})
    robosync::testing::expect_golden(disassembly_folder() / (std::string(name) + ".txt"),
                                     disassembly(example(name)));
}

TEST_CASE("programs become these instructions", "[golden]") {
  for (const auto& entry : fs::directory_iterator(disassembly_folder())) {
    if (entry.path().extension() != ".rsl") continue;
    fs::path golden = entry.path();
    golden.replace_extension(".txt");
    robosync::testing::expect_golden(golden, disassembly(common(read_file(entry.path()))));
  }
}

TEST_CASE("the same input gives the same bytes, another program another name") {
  const Result first = example("touch_companion", true);
  const Result second = example("touch_companion", true);
  CHECK(first.image == second.image);
  const std::string program = rule("touch LEVEL > 3");
  const auto hash = [&](const std::string& text, const std::string& robot) {
    const Result result = compile_text(text, robot);
    return view(result).header->program_hash;
  };
  CHECK(hash(program, common_robot()) == hash(program, common_robot()));
  CHECK(hash(program, common_robot()) == hash(program + "\n", common_robot()));
  CHECK(hash(program, common_robot()) != hash(rule("touch LEVEL > 4"), common_robot()));
}

TEST_CASE("only what the program uses travels") {
  const Result result = common(rule("room NOISE > 30", "LIGHT lamp ON"));
  const vm::Image image = view(result);
  REQUIRE(image.sensors.size() == 1);
  REQUIRE(image.channels.size() == 1);
  CHECK(image.string(image.sensors[0].name) == "room");
  CHECK(image.string(image.channels[0].name) == "NOISE");
  REQUIRE(image.actuators.size() == 1);
  CHECK(image.string(image.actuators[0].name) == "lamp");
  CHECK(image.actuators[0].verbs == 1);
  CHECK(image.groups.empty());
  CHECK(image.verbs.size() == 1);
  CHECK(image.words.size() == 1);
}

TEST_CASE("equal code and constants are kept once") {
  const std::string one = rule("touch LEVEL > 3", "MOVE arms SLOWLY");
  const vm::Image once = view(common(one));
  const Result twice = common(one + one);
  const vm::Image image = view(twice);
  CHECK(image.rules.size() == 2);
  CHECK(image.responses.size() == 1);
  CHECK(image.code.size() == once.code.size());
  CHECK(image.constants.size() == 1);
  CHECK(image.inputs.size() == 1);
  CHECK(image.rules[0].condition_start == image.rules[1].condition_start);
}

TEST_CASE("behaviours stand in the order of their priorities") {
  const std::string inner = rule("touch LEVEL > 3");
  const Result result = common(inner + "BEHAVIOR low PRIORITY 1\n" + inner + "END\n" + inner +
                               "BEHAVIOR high PRIORITY 99\n" + inner + inner + "END\n");
  const vm::Image image = view(result);
  REQUIRE(image.behaviors.size() == 4);
  const std::vector<int> expected = {99, 1, 0, -1};
  for (std::size_t i = 0; i < expected.size(); ++i)
    CHECK(image.behaviors[i].priority == expected[i]);
  CHECK(image.string(image.behaviors[0].name) == "high");
  CHECK(image.behaviors[0].rule_count == 2);
  CHECK(image.behaviors[2].name == vm::kNoIndex);
  CHECK(image.rules[image.behaviors[2].first_rule].line == 1);
  CHECK(image.rules[image.behaviors[3].first_rule].line == 11);
}

TEST_CASE("a group whose members understand a command differently gets one for each") {
  const Result alike = common(rule("touch LEVEL > 3", "MOVE arms TO 20deg"));
  CHECK(view(alike).groups.size() == 1);
  const std::string differ = R"({
    "sensors": [{"name": "touch", "type": "VIRTUAL"}],
    "actuators": [
      {"name": "left_arm", "type": "VIRTUAL", "device": "servo"},
      {"name": "right_arm", "type": "VIRTUAL", "device": "servo", "speeds": {"SLOWLY": "10deg/s"}}],
    "groups": {"arms": ["left_arm", "right_arm"]}})";
  const Result result = compile_text(rule("touch LEVEL > 3", "MOVE arms SLOWLY"), differ);
  const vm::Image image = view(result);
  CHECK(image.groups.empty());
  CHECK(image.words.size() == 2);
  CHECK(image.responses[0].length == 2);
  CHECK(image.responses[0].actuators == 3);
}

TEST_CASE("conditions mean what they say") {
  const auto value = [](const std::string& condition, std::vector<vm::Value> frame) {
    return evaluate(common(rule(condition)), std::move(frame));
  };
  CHECK(value("touch LEVEL > 3", {3001}) == vm::kTrue);
  CHECK(value("touch LEVEL > 3", {3000}) == vm::kFalse);
  CHECK(value("3 < touch LEVEL", {3001}) == vm::kTrue);
  CHECK(value("3 <= touch LEVEL", {3000}) == vm::kTrue);
  CHECK(value("3 >= touch LEVEL", {3001}) == vm::kFalse);
  CHECK(value("touch LEVEL > 3", {vm::kUnknown}) == vm::kUnknown);
  CHECK(value("touch LEVEL > 3 OR NOT touch LEVEL > 3", {vm::kUnknown}) == vm::kUnknown);
  // Inputs stand in the order of robot.json: touch LEVEL, then proximity DISTANCE.
  CHECK(value("proximity DISTANCE < 20cm AND touch LEVEL > 3", {4000, 199999}) == vm::kTrue);
  CHECK(value("proximity DISTANCE < 20 AND touch LEVEL > 3", {4000, 200000}) == vm::kFalse);
  CHECK(value("proximity DISTANCE >= touch LEVEL * 10cm", {2000, 200000}) == vm::kTrue);
  CHECK(value("proximity DISTANCE > touch LEVEL * 10cm", {2000, 200000}) == vm::kFalse);
  CHECK(value("touch LEVEL - (touch LEVEL - (touch LEVEL - 1)) = 2", {3000}) == vm::kTrue);
  CHECK(value("-touch LEVEL / 2 MOD 2 <> -1.5", {3000}) == vm::kTrue);  // 0.5: the divisor's sign
  CHECK(value("proximity DISTANCE / 1m + touch LEVEL <= 3.5", {3000, 500000}) == vm::kTrue);
  CHECK(value("proximity DISTANCE + 2 < 30", {279999}) == vm::kTrue);  // 2 and 30 are cm
  CHECK(value("proximity DISTANCE + 2 < 30", {280000}) == vm::kFalse);
}

TEST_CASE("a constant is folded to what the robot would compute") {
  for (const char* op : {"+", "-", "*", "/", "MOD"})
    for (const char* left : {"0", "0.001", "1", "7.5", "333.333", "1999.999"})
      for (const char* right : {"0.003", "1", "7", "12.345", "999.999"}) {
        const std::string zero = " + touch LEVEL * 0) ";
        const std::string condition = "(" + std::string(left) + zero + op + " (" + right + zero +
                                      "= " + left + " " + op + " " + right;
        INFO(condition);
        CHECK(evaluate(common(rule(condition)), {5000}) == vm::kTrue);
      }
}

TEST_CASE("a comparison with the 300th constant takes the long way") {
  std::string program;
  for (int behavior = 1; behavior <= 3; ++behavior) {
    const std::string number = std::to_string(behavior);
    program += "BEHAVIOR b" + number + " PRIORITY " + number;
    for (int i = 100; i < 200; ++i) {
      program += "\n";
      program += rule("touch LEVEL < " + number + "." + std::to_string(i));
    }
    program += "END\n";
  }
  const Result result = common(program);
  CHECK(view(result).constants.size() == 300);
  const std::string text = disassembly(result);
  CHECK(text.find("lt  ") != std::string::npos);
}

TEST_CASE("source lines say where code comes from, and can be left out") {
  const std::string program =
      "WHEN touch LEVEL > 3\nDO\n  MOVE left_arm SLOWLY\n  MOVE right_arm SLOWLY\nEND\n";
  const Result with = common(program, true);
  const vm::Image image = view(with);
  REQUIRE(image.source_lines.size() == 3);
  CHECK(image.source_lines[0].line == 1);
  CHECK(image.source_lines[1].line == 3);
  CHECK(image.source_lines[1].word == image.responses[0].start);
  CHECK(image.source_lines[2].line == 4);
  CHECK(view(common(program, false)).source_lines.empty());
}

TEST_CASE("a sound's own length travels with the command, unless the program says FOR") {
  const std::string robot = R"({
    "sensors": [{"name": "touch", "type": "VIRTUAL"}],
    "actuators": [{"name": "sound", "type": "UART", "device": "dfplayer",
                   "sounds": ["a.wav", {"file": "b.wav", "duration": "2.5s"},
                              {"file": "c.wav", "duration": "1s"}]}]})";
  const auto code = [&](const std::string& body) {
    const Result result = compile_text(rule("touch LEVEL > 3", body), robot);
    INFO(messages(result));
    REQUIRE(!result.image.empty());
    std::string text = disassembly(result);
    return text.substr(text.find("ret"));
  };
  CHECK(code("PLAY sound 'a.wav'").find("for") == std::string::npos);
  CHECK(code("PLAY sound 'b.wav'").find("2.5") != std::string::npos);
  CHECK(code("PLAY sound 'c.wav'").find("for") == std::string::npos);
  CHECK(code("PLAY sound 'b.wav' FOR 3s").find("2.5") == std::string::npos);
}

TEST_CASE("a word of the program can be said, alone or in a text, and counts as one word") {
  const std::string robot = R"({
    "sensors": [{"name": "touch", "type": "VIRTUAL"}],
    "actuators": [{"name": "mouth", "type": "VIRTUAL", "device": "speaker"}]})";
  // What is said, and for how long.
  const auto said = [&](const std::string& body) {
    const Result result =
        compile_text("STATE mood: calm, very happy, sad\n" + rule("touch LEVEL > 3", body), robot);
    INFO(messages(result));
    REQUIRE(!result.image.empty());
    const vm::Image image = view(result);
    REQUIRE(image.words.size() == 1);
    return std::pair(std::string(image.string(image.words[0].name)), image.words[0].value);
  };
  const std::string mood = "{|calm|very happy|sad}";
  CHECK(said("SAY mood") == std::pair(mood, 350));
  CHECK(said("SAY \"I am\", mood") == std::pair("I am " + mood, 3 * 350));
  CHECK(said("SAY mouth mood FOR 2s") == std::pair(mood, 0));
  CHECK(messages(compile_text("STATE mood: calm, happy\n" + rule("touch LEVEL > 3", "SAY FOR mood"),
                              robot))
            .find("`mood` is a word, not a number") != std::string::npos);
}

TEST_CASE("wiring travels as robot.json has it") {
  const std::string robot = R"({
    "sensors": [{"name": "oven", "type": "I2C", "address": "0x48", "bus": 0, "register": 7,
      "channels": {"HEAT": {"input": 9, "unit": "F", "range": ["32F", "212F"], "rate": "4Hz",
                            "change": "9F", "scale": "0.18F", "stale_after": "3s"}}}],
    "actuators": [{"name": "fan", "type": "PWM", "pin": 6, "limits": {"SPEED": "70%"},
                   "on_release": "hold", "safe": "rest"}]})";
  const Result result = compile_text(rule("oven HEAT > 50C", "RUN fan TO 30%"), robot);
  INFO(messages(result));
  const vm::Image image = view(result);
  const vm::Sensor& sensor = image.sensors[0];
  CHECK(sensor.driver == vm::DriverId::i2c_register);
  CHECK(sensor.bus == 0);
  CHECK(sensor.address == 0x48);
  CHECK(sensor.period_ms == 250);
  const vm::Channel& channel = image.channels[0];
  CHECK(channel.input == 9);
  CHECK(channel.dimension == vm::Dimension::temperature);
  CHECK(channel.min == 0);
  CHECK(channel.max == 100000);
  CHECK(channel.change == 5000);    // a difference of 9 F, not the temperature 9 F
  CHECK(channel.scale_num == 100);  // 0.18 F a count is 0.1 C
  CHECK(channel.scale_den == 1);
  CHECK(channel.offset == -17778);  // a count of 0 is 0 F
  CHECK(channel.stale_ms == 3000);
  const vm::Actuator& actuator = image.actuators[0];
  CHECK(actuator.driver == vm::DriverId::pwm);
  CHECK(actuator.pin == 6);
  CHECK(actuator.speed_limit == 70000);
  CHECK(actuator.min == 0);
  CHECK(actuator.max == 70000);  // TO says power, too
  CHECK(actuator.on_release == vm::Release::hold);
  CHECK(actuator.safe == vm::Release::rest);
}

TEST_CASE("a motor's record has both pins; one that is only shown has none") {
  const auto record = [](const std::string& wiring) {
    const std::string robot =
        R"({"sensors": [{"name": "near", "type": "VIRTUAL"}], "actuators": [{"name": "wheel", "device": "motor", )" +
        wiring + "}]}";
    const Result result = compile_text(rule("near > 2", "RUN wheel BACKWARD"), robot);
    return view(result).actuators[0];
  };
  const vm::Actuator wired = record(R"("type": "PWM", "pins": ["6", 31])");
  CHECK(wired.driver == vm::DriverId::motor);
  CHECK(wired.pin == 6);
  CHECK(wired.bus == 31);
  CHECK(wired.min == -100'000);
  CHECK(wired.safe == vm::Release::coast);
  const vm::Actuator shown = record(R"("type": "VIRTUAL", "pins": [6, 31])");
  CHECK(shown.driver == vm::DriverId::virtual_output);
  CHECK(shown.bus == static_cast<std::uint8_t>(vm::VirtualOutput::level));
  const vm::Actuator limited = record(R"("type": "VIRTUAL", "limits": {"SPEED": "50%"})");
  CHECK(limited.driver == vm::DriverId::virtual_output);  // what is limited is power, no way
  for (const char* const type : {R"("type": "PWM", "pins": [3, 4])", R"("type": "VIRTUAL")"}) {
    const vm::Actuator slow = record(type + std::string(R"(, "limits": {"SPEED": "40%"})"));
    CHECK(slow.min == -40'000);
    CHECK(slow.max == 40'000);
  }
}

TEST_CASE("what is fed is neither sampled nor stale") {
  const std::string robot = R"({
    "sensors": [{"name": "sonar", "type": "VIRTUAL", "pin": 5, "device": "hc-sr04"}],
    "actuators": [{"name": "arm", "type": "VIRTUAL", "device": "servo"}]})";
  const Result result = compile_text(rule("sonar < 20cm", "MOVE arm SLOWLY"), robot);
  const vm::Image image = view(result);
  CHECK(image.sensors[0].driver == vm::DriverId::virtual_sensor);
  CHECK(image.sensors[0].period_ms == 0);
  CHECK(image.channels[0].stale_ms == 0);
  CHECK(image.actuators[0].driver == vm::DriverId::virtual_motion);
  CHECK(image.actuators[0].pin == 90);
}

TEST_CASE("what is fed is stale when robot.json says so, also after five periods of its rate") {
  const auto stale_ms = [](const std::string& channel) {
    const std::string robot =
        R"({"sensors": [{"name": "touch", "type": "VIRTUAL", "channels": {"LEVEL": )" + channel +
        R"(}}], "actuators": [{"name": "arm", "type": "VIRTUAL", "device": "servo"}]})";
    return view(compile_text(rule("touch LEVEL > 3", "MOVE arm SLOWLY"), robot))
        .channels[0]
        .stale_ms;
  };
  CHECK(stale_ms(R"({"rate": "10Hz", "stale_after": "500ms"})") == 500);
  CHECK(stale_ms(R"({"rate": "10Hz", "stale_after": "501ms"})") == 501);
  CHECK(stale_ms(R"({"stale_after": "100ms"})") == 100);
  CHECK(stale_ms(R"({"rate": "10Hz"})") == 0);
}

TEST_CASE("a bare number added to a Fahrenheit channel is a difference") {
  const std::string robot = R"({
    "sensors": [{"name": "oven", "type": "VIRTUAL", "channels": {"HEAT": {"unit": "F"}}}],
    "actuators": [{"name": "arm", "type": "VIRTUAL", "device": "servo"}]})";
  const Result result = compile_text(rule("oven HEAT + 9 > 50", "MOVE arm SLOWLY"), robot);
  CHECK(evaluate(result, {5001}) == vm::kTrue);  // 5 C + 5 C against 10 C
  CHECK(evaluate(result, {5000}) == vm::kFalse);
}
