// What an editor is told about a robot.json: completion, hover and outline, also while it is no JSON.
#include "compiler/query/configuration.hpp"

#include <algorithm>
#include <random>

#include <catch2/catch.hpp>

#include "compiler/config/fields.hpp"
#include "tests/compiler/compiled.hpp"
#include "tests/rsc/lsp/editor.hpp"

using namespace robosync;
using Catch::Contains, Catch::StartsWith;
using test::Editor, test::Json, test::Marked, test::Words, test::has, test::has_all;

namespace {

// The answer about the marked place of a robot.json, beside a program.
Json asked(const std::string& method, const std::string& marked) {
  Editor editor(
      Json{{"textDocument", {{"documentSymbol", {{"hierarchicalDocumentSymbolSupport", true}}}}}});
  const Marked text(marked);
  editor.open("robot.rsl", "WHEN touch LEVEL > 3 DO MOVE arms TO 30deg OVER 1s\nEND\n");
  editor.open("robot.json", text.text);
  return editor.ask(
      "textDocument/" + method,
      {{"textDocument", {{"uri", editor.uri("robot.json")}}}, {"position", text.place}});
}

Words offered_in_robot(const std::string& marked) {
  Words labels;
  const Json result = asked("completion", marked);
  for (const Json& item : result.at("items"))
    labels.push_back(item.at("label"));
  return labels;
}

std::string hover_in_robot(const std::string& marked) {
  const Json said = asked("hover", marked);
  return said.is_null() ? "" : said.at("contents").at("value").get<std::string>();
}

}  // namespace

// ---- completion

TEST_CASE("a robot.json is offered the keys that an object lacks, also while it is no JSON yet") {
  const auto of_robot = offered_in_robot("{\"sensors\": [],\n  |\n  \"groups\": {}}\n");
  CHECK(has_all(of_robot, {"board", "actuators", "pictures"}));
  CHECK_FALSE(has(of_robot, "sensors"));
  CHECK_FALSE(has(of_robot, "groups"));
  const auto of_sensor = offered_in_robot("{\"sensors\": [{\"name\": \"touch\", \"de|\n");
  CHECK(has_all(of_sensor, {"device", "channels"}));
  CHECK_FALSE(has(of_sensor, "name"));
  CHECK_FALSE(has(of_sensor, "speeds"));
  const std::string channel =
      "{\"sensors\": [{\"channels\": {\"LEVEL\": {\"range\": [0, 9], |}}}]}\n";
  CHECK(has_all(offered_in_robot(channel), {"rate", "stale_after"}));
  CHECK(has(offered_in_robot("{\"actuators\": [{\"limits\": {|"), "SPEED"));
  CHECK(offered_in_robot("{\"sensors\": [{\"channels\": {|").empty());  // names of one's own
  CHECK(offered_in_robot("{\"sensors\": [|").empty());
  CHECK(offered_in_robot("|").empty());
}

TEST_CASE("a robot.json is offered devices, types and boards, each in its place") {
  const auto sensor = offered_in_robot("{\"sensors\": [{\"device\": \"|\"}]}\n");
  CHECK(has_all(sensor, {"hc-sr04", "button"}));
  CHECK_FALSE(has(sensor, "servo"));
  CHECK(has(offered_in_robot("{\"actuators\": [{\"device\": |"), "servo"));
  CHECK(has(offered_in_robot("{\"actuators\": [{\"type\": \"P|"), "PWM"));
  CHECK(has(offered_in_robot("{\"board\": |"), "microbit-v2"));
  CHECK(offered_in_robot("{\"name\": \"|\"}").empty());
}

TEST_CASE("what is completed in a robot.json replaces what is typed, with its quotes") {
  const Json items = asked("completion", "{\"boa|\": 1}\n").at("items");
  const auto board =
      std::ranges::find_if(items, [](const Json& one) { return one.at("label") == "board"; });
  REQUIRE(board != items.end());
  CHECK(board->at("textEdit").at("newText") == "\"board\"");
  CHECK(board->at("textEdit").at("range").at("start").at("character") == 1);
  CHECK(board->at("textEdit").at("range").at("end").at("character") == 6);
}

// ---- hover

namespace {

// The beginning of a robot.json with such an object, in which a key comes next.
std::string before_key(compiler::Object object) {
  switch (object) {
    case compiler::Object::robot:
      return "{";
    case compiler::Object::sensor:
      return R"({"sensors": [{)";
    case compiler::Object::channel:
      return R"({"sensors": [{"channels": {"X": {)";
    case compiler::Object::actuator:
      return R"({"actuators": [{)";
    case compiler::Object::trim:
      return R"({"actuators": [{"trim": {)";
    case compiler::Object::sound:
      return R"({"actuators": [{"sounds": [{)";
    case compiler::Object::limits:
      return R"({"actuators": [{"limits": {)";
    case compiler::Object::behavior:
      return R"({"behaviors": [{)";
    case compiler::Object::algorithm:
      return R"({"algorithms": [{)";
    case compiler::Object::scheduler:
      return R"({"scheduler": {)";
    case compiler::Object::safety:
      return R"({"safety": {)";
    default:
      return "";
  }
}

// Every text with the key `description` in the schema.
void add_descriptions(const nlohmann::json& schema, std::string& all) {
  if (schema.is_object() && schema.contains("description") && schema["description"].is_string())
    all += schema["description"].get<std::string>() + "\n";
  for (const nlohmann::json& one : schema)
    if (one.is_structured()) add_descriptions(one, all);
}

}  // namespace

TEST_CASE("hover says nothing of a key that belongs to another object") {
  CHECK(hover_in_robot("{\"chan|nels\": {}}").empty());
  CHECK(hover_in_robot("{\"sensors\": [{\"sam|ples\": 1}]}").empty());
}

TEST_CASE("hover says of every key of robot.json what the schema says") {
  std::string all;
  add_descriptions(nlohmann::json::parse(compiler::testing::read_file(
                       compiler::testing::source_folder() / "grammar/robot.schema.json")),
                   all);
  std::size_t keys = 0;
  for (const compiler::Key& key : compiler::known_keys()) {
    const std::string before = before_key(key.object);
    if (before.empty()) continue;
    const compiler::SourceFile source("", before + "\"" + std::string(key.name) + "\": ");
    const auto said = compiler::query::describe_configuration(
        source, 0, static_cast<std::uint32_t>(before.size()), {});
    CAPTURE(before, key.name, said.about.text);
    CHECK(said.name == key.name);
    const std::string meaning = said.about.text.substr(0, said.about.text.find('\n') + 1);
    CHECK(meaning.size() > 10);
    CHECK_THAT(all, Contains(meaning));
    CHECK_THAT(said.about.text, Contains("\nValue: ") && !Contains("$"));
    ++keys;
  }
  CHECK(keys >= 90);
}

TEST_CASE("hover over a key of robot.json says its object, its values and their range") {
  CHECK_THAT(hover_in_robot("{\"sensors\": [{\"addr|ess\": 5}]}"),
             StartsWith("address, a key of `sensor`\nI2C address, 0x08 to 0x77.\n") &&
                 Contains("\"0x48\""));
  CHECK_THAT(hover_in_robot("{\"sensors\": [{\"active\": \"lo|w\"}]}"),
             Contains("Value: low, high"));
  CHECK_THAT(hover_in_robot("{\"actuators\": [{\"trim\": {|\"left\": 90"),
             Contains("`trim`") && Contains("left motor"));
  CHECK_THAT(hover_in_robot("{\"sensors\": [{\"channels\": {\"X\": {\"un|it\": \n"),
             Contains("lux, dB"));
  CHECK(hover_in_robot("{\"sensors\": [{\"adress|\": 5}]}").empty());
  CHECK(hover_in_robot("{\"sensors\": [{\"pins\": [\"4|\"]}]}").empty());
  CHECK(hover_in_robot("{\"x\": {\"na|me\": 1}}").empty());
  CHECK(hover_in_robot("\"na|me\"").empty());
  CHECK(hover_in_robot("|").empty());
}

TEST_CASE("hover over a device says what it does, measures and needs") {
  CHECK_THAT(hover_in_robot("{\"sensors\": [{\"device\": \"hc-s|r04\"}]}"),
             StartsWith("hc-sr04, a device\n") && Contains("an ultrasonic distance sensor") &&
                 Contains("Wiring: `trigger` and `echo`.") &&
                 Contains("`DISTANCE`: from 2cm to 400cm. It is read every 67 ms."));
  CHECK_THAT(hover_in_robot("{\"sensors\": [{\"device\": \"mpu|6050\", "),  // no JSON yet
             Contains("Type: I2C. Wiring: `bus` and `address`, `0x68 to 0x69`.") &&
                 Contains("`TURN_X`: from -500deg/s to 500deg/s."));
  CHECK_THAT(hover_in_robot("{\"actuators\": [{\"device\": |\"servo\"}]}"),
             Contains("Type: PWM. Wiring: `pin`.") && Contains("`MOVE`") &&
                 Contains("Range: from 0deg to 180deg."));
  CHECK_THAT(hover_in_robot("{\"actuators\": [{\"device\": \"pca9685_serv|o\"}]}"),
             Contains("`channel` and `enable`"));
  CHECK_THAT(
      hover_in_robot("{\"board\": \"microbit-v2\", \"actuators\": [{\"device\": \"ligh|ts\"}]}"),
      StartsWith("lights, a part of the board microbit-v2\n") && Contains("`SHOW`") &&
          !Contains("Wiring"));
  // An actuator is no sensor: then the key is described.
  CHECK_THAT(hover_in_robot("{\"sensors\": [{\"device\": \"ser|vo\"}]}"),
             StartsWith("device, a key"));
}

TEST_CASE("hover over a board gives its figures") {
  CHECK_THAT(hover_in_robot("{\"board\": \"micro|bit-v2\"}"),
             StartsWith("microbit-v2, a board\n114688 bytes for a program") &&
                 Contains("Buses: 2 I2C, 1 SPI.") &&
                 Contains("Outputs: `0 to 2` and `12 to 14`.") && Contains("Parts: `lights`, "));
  CHECK_THAT(hover_in_robot("{\"board\": \"micro|bit-v3\"}"),
             StartsWith("board, a key of `robot`"));
}

TEST_CASE("hover over a name of robot.json says where the program uses it") {
  std::string robot = test::kEditorsRobot;
  robot.insert(robot.find("touch") + 1, "|");
  CHECK_THAT(hover_in_robot(robot),
             StartsWith("touch, a sensor\n") && Contains("Used at `robot.rsl:1`."));
  robot = test::kEditorsRobot;
  robot.insert(robot.find("button") + 1, "|");
  CHECK_THAT(hover_in_robot(robot), StartsWith("button, a sensor\n") && !Contains("Used at"));
}

TEST_CASE("what a hover in robot.json is about is counted in UTF-16") {
  const std::string before = "{\"name\": \"🤖\", ";
  const Json range = asked("hover", before + "\"bo|ard\": 1}").at("range");
  CHECK(range.at("start") == Marked(before + "|").place);
  CHECK(range.at("end") == Marked(before + "\"board\"|").place);
}

// ---- outline

namespace {

// "sensors 3 (touch 19 (LEVEL 8)) ": names and kinds.
std::string shown_symbols(const Json& symbols) {
  std::string text;
  for (const Json& one : symbols) {
    text += one.at("name").get<std::string>() + " " + std::to_string(one.at("kind").get<int>());
    if (!one.at("children").empty()) text += " (" + shown_symbols(one.at("children")) + ")";
    text += " ";
  }
  return text;
}

std::string outline(const std::string& text) {
  return shown_symbols(asked("documentSymbol", text + "|"));
}

}  // namespace

TEST_CASE("the parts of a robot are listed, each in its section") {
  CHECK(outline(test::kEditorsRobot) ==
        "sensors 3 (touch 19 (LEVEL 8 ) proximity 19 (DISTANCE 8 ) button 19 (POSITION 8 ) ) "
        "actuators 3 (left_arm 19 right_arm 19 sound 19 ) groups 3 (arms 18 ) ");
  CHECK(outline(R"({"behaviors": [{"priority": 3, "name": "hug"}], "safety": {"start": "1s"},
                    "algorithms": [{"name": "hand", "config": {"x": [1]}}], "name": "Robo",
                    "actuators": [{"name": "a", "limits": {"SPEED": 3}, "trim": {}}],
                    "pictures": {"smile": ["#...#"]}})") ==
        "behaviors 3 (hug 5 ) safety 3 algorithms 3 (hand 12 ) actuators 3 (a 19 ) "
        "pictures 3 (smile 18 ) ");
}

TEST_CASE("an outline shows what can be understood of a robot.json that is no JSON") {
  CHECK(outline(R"({"sensors": [{"name": "touch", "chan)") == "sensors 3 (touch 19 ) ");
  // A bracket is missing behind `touch`, and one too many is at the end.
  CHECK(
      outline(
          R"({"sensors": [{"name": "touch", "channels": {"LEVEL": {}], "groups": {"g": []}}}})") ==
      "sensors 3 (touch 19 (LEVEL 8 ) ) groups 3 (g 18 ) ");
  // Editors refuse an item without a name.
  CHECK(outline(R"({"sensors": [{}, {"name": " "}], "": {}})") == "sensors 3 (? 19 ? 19 ) ? 3 ");
  CHECK(outline("{ : {").empty());
  CHECK(outline("").empty());
  CHECK(outline(std::string(100'000, '[')).empty());
}

TEST_CASE("an item of the outline is its whole object, and is found by its name") {
  const std::string robot = "{\"name\": \"🤖\", \"sensors\": [ {\"name\": \"é🤖\"} ]}";
  const Json section = asked("documentSymbol", robot + "|").at(0);
  const auto place = [&](const std::string& part, std::size_t behind) {
    std::string marked = robot;
    return Marked(marked.insert(marked.find(part) + behind, "|")).place;
  };
  CHECK(section.at("range").at("start") == place("\"sensors", 0));
  CHECK(section.at("range").at("end") == place(" ]}", 2));
  CHECK(section.at("selectionRange").at("start") == place("sensors", 0));
  const Json& sensor = section.at("children").at(0);
  CHECK(sensor.at("range").at("start") == place("{\"name\": \"é", 0));
  CHECK(sensor.at("range").at("end") == place("} ]", 1));
  CHECK(sensor.at("selectionRange").at("start") == place("é🤖", 0));
  CHECK(sensor.at("selectionRange").at("end") == place("\"} ]", 0));
}

TEST_CASE("a flat client gets the outline of robot.json, and other JSON has none") {
  Editor editor;
  editor.open("robot.json", test::kEditorsRobot);
  const auto symbols = [&](const std::string& name) {
    return editor.ask("textDocument/documentSymbol",
                      {{"textDocument", {{"uri", editor.uri(name)}}}});
  };
  const Json all = symbols("robot.json");
  REQUIRE(all.size() == 13);
  CHECK(all[2].at("name") == "LEVEL");
  CHECK(all[2].at("containerName") == "touch");
  editor.open("touches.json", "{\"x\": {}}");
  CHECK(symbols("touches.json").is_null());
}

namespace {

void check_items(const std::vector<compiler::query::OutlineItem>& items, compiler::Span outside) {
  for (const auto& item : items) {
    CHECK((outside.begin <= item.span.begin && item.span.end <= outside.end));
    CHECK((item.span.begin <= item.name_span.begin && item.name_span.end <= item.span.end));
    CHECK(!item.name.empty());
    check_items(item.inside, item.span);
  }
}

}  // namespace

TEST_CASE("whatever is missing or repeated in a robot.json, its outline is in order") {
  std::mt19937 random(5);
  for (int i = 0; i < 2000; ++i) {
    std::string text = test::kEditorsRobot;
    for (int change = 0; change < 4; ++change) {
      const std::size_t at = random() % text.size(), size = random() % 20;
      if (random() % 2 == 0)
        text.erase(at, size);
      else
        text.insert(at, text.substr(random() % text.size(), size));
    }
    if (random() % 2 == 0) text.resize(random() % text.size());
    const compiler::SourceFile source("", text);
    CAPTURE(text);
    check_items(compiler::query::outline_configuration(source, 0),
                {0, 0, static_cast<std::uint32_t>(text.size())});
    for (const std::size_t at : {random() % (text.size() + 1), text.size()})
      CHECK_NOTHROW(
          compiler::query::describe_configuration(source, 0, static_cast<std::uint32_t>(at), {}));
  }
}
