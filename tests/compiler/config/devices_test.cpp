// The device descriptors of stdlib/devices, and that robot.schema.json says what the reader does.
#include "compiler/config/devices.hpp"

#include <algorithm>
#include <map>
#include <set>

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "compiler/config/boards.hpp"
#include "compiler/config/entries.hpp"
#include "compiler/config/fields.hpp"
#include "compiler/config/wiring.hpp"
#include "compiler/diagnostics/render.hpp"
#include "compiler/units/units.hpp"
#include "rsc/algorithm_modules.hpp"
#include "tests/compiler/compiled.hpp"
#include "tests/support/golden.hpp"
#include "vm/drivers.hpp"

using namespace robosync;
using namespace robosync::compiler;
using namespace robosync::compiler::testing;

namespace {

const nlohmann::json& schema() {
  static const auto text =
      nlohmann::json::parse(read_file(source_folder() / "grammar/robot.schema.json"));
  return text;
}

// The schema's description of one kind of object.
const nlohmann::json& described(Object object) {
  const auto& definitions = schema().at("definitions");
  switch (object) {
    case Object::robot:
      return schema();
    case Object::sensor:
      return definitions.at("sensor");
    case Object::channel:
      return definitions.at("channel");
    case Object::actuator:
      return definitions.at("actuator");
    case Object::trim:
      return definitions.at("actuator").at("properties").at("trim");
    case Object::sound:
      return definitions.at("sound");
    case Object::limits:
      return definitions.at("limits");
    case Object::behavior:
      return definitions.at("behavior");
    case Object::scheduler:
      return definitions.at("scheduler");
    case Object::safety:
      return definitions.at("safety");
    default:
      return definitions.at("algorithm");
  }
}

std::set<std::string> keys_of(Object object) {
  std::set<std::string> keys;
  for (const Key& key : known_keys())
    if (key.object == object) keys.emplace(key.name);
  return keys;
}

// Every object key in a JSON file with the kind of object it stands in, checked against the schema.
void check_keys(const nlohmann::json& value, Object object) {
  for (const auto& [key, member] : value.items()) {
    INFO(key);
    CHECK(described(object).at("properties").contains(key));
  }
}

// Each, and whether it is a sensor.
std::map<std::string, bool> parts_of_boards() {
  std::map<std::string, bool> parts;
  for (std::size_t i = 0; i < board_names().size(); ++i)
    for (const Board::Part& part : board_at(i).parts)
      parts.emplace(part.name, find_device(part.device, true) != nullptr);
  return parts;
}

}  // namespace

TEST_CASE("every descriptor is read without a word") {
  CHECK(device_texts().size() >= 10);
  for (const DeviceText& text : device_texts()) {
    INFO(text.name);
    Diagnostics diagnostics;
    const Device device = read_device(text, diagnostics);
    for (const Diagnostic& diagnostic : diagnostics.all()) {
      INFO(diagnostic.message);
      CHECK(false);
    }
    CHECK(text.is_sensor == device.is_sensor);
    CHECK(text.type == device.type);
    CHECK(text.is_default == device.is_default);
    CHECK(find_device(text.name, text.is_sensor) != nullptr);
    CHECK(find_device(text.name, !text.is_sensor) == nullptr);
    CHECK(!device.doc.empty());
    if (device.is_sensor)
      CHECK(!device.sensor.channels.empty());
    else
      CHECK(!device.actuator.verbs.empty());
  }
}

TEST_CASE("what a device lacks is in what an editor says of its wiring") {
  constexpr std::string_view needs = " needs the key ";
  unsigned found = 0;
  for (const DeviceText& text : device_texts()) {
    const nlohmann::json part = {{"name", "x"}, {"type", text.type}, {"device", text.name}};
    const nlohmann::json robot = {{text.is_sensor ? "sensors" : "actuators", {part}}};
    const std::string wiring = wiring_of(*find_device(text.name, text.is_sensor));
    const Result result = compile_text("", robot.dump());
    for (const Diagnostic& diagnostic : result.diagnostics.all()) {
      const std::size_t at = diagnostic.message.find(needs);
      if (at == std::string::npos) continue;
      INFO(diagnostic.message << "; " << wiring);
      CHECK(wiring.find(diagnostic.message.substr(at + needs.size())) != std::string::npos);
      ++found;
    }
  }
  CHECK(found > 20);
}

TEST_CASE("a descriptor's mistakes are found") {
  const auto mistakes = [](std::string_view json) {
    Diagnostics diagnostics;
    const Device device = read_device({"x", json}, diagnostics);
    static_cast<void>(device);
    return diagnostics.errors();
  };
  CHECK(mistakes(R"({"kind": "sensor", "type": "I2C", "channels": {"LEVEL": {}}})") == 0);
  CHECK(mistakes(R"({"kind": "sensor", "type": "I2C", "driver": "max3445"})") == 1);
  CHECK(mistakes(R"({"kind": "actuator", "type": "PWM", "verbs": {"GO": {"action": "fly"}}})") ==
        1);
  CHECK(mistakes(R"({"kind": "actuator", "type": "PWM", "words": {"FAST": {"speed": 3}}})") == 1);
  CHECK(
      mistakes(
          R"({"kind": "actuator", "type": "PWM", "verbs": {"GO": {"action": "move", "takes": ["direction"]}},
                "words": {"LEFT": {"verbs": ["GO", "FLY"], "direction": -1}}})") == 1);
  CHECK(mistakes(R"({"kind": "actuator", "type": "PWM", "to": {"unit": "degs"}})") == 1);
  CHECK(mistakes("[") == 1);
}

TEST_CASE("a word's parameter is one that some verb of its device takes") {
  for (const DeviceText& text : device_texts()) {
    Diagnostics diagnostics;
    const Device device = read_device(text, diagnostics);
    for (const WordConfig& word : device.actuator.words) {
      INFO(device.name << " " << word.name);
      CHECK(std::ranges::any_of(device.actuator.verbs,
                                [&](const VerbConfig& verb) { return verb.goes_with(word); }));
    }
  }
}

// `DRIVE base LEFT` must not be a way backward, nor `TURN base FORWARD` a turn to the right.
TEST_CASE("a direction belongs to ways or to turns on the spot, not to both") {
  for (const DeviceText& text : device_texts()) {
    Diagnostics diagnostics;
    const Device device = read_device(text, diagnostics);
    for (const WordConfig& word : device.actuator.words) {
      if (word.param != vm::Param::direction) continue;
      std::set<vm::Action> actions;
      for (const VerbConfig& verb : device.actuator.verbs)
        if (verb.goes_with(word)) actions.insert(verb.action);
      INFO(device.name << " " << word.name);
      CHECK((!actions.contains(vm::Action::move) || !actions.contains(vm::Action::play)));
    }
  }
}

// What the compiler allows, the verifier of the image must, too (vm::moves_at_a_speed()).
TEST_CASE("each device that can have a limit of acceleration has it in an image that is accepted") {
  std::size_t found = 0;
  for (const DeviceText& text : device_texts()) {
    Diagnostics diagnostics;
    const Device device = read_device(text, diagnostics);
    if (device.is_sensor) continue;
    const Result result = compile_text(
        "AT START DO\n  STOP it\nEND\n",
        R"({"actuators": [{"name": "it", "type": "VIRTUAL", "limits": {"ACCELERATION": 40}, "device": ")" +
            device.name + "\"}]}");
    INFO(device.name << messages(result));
    ActuatorConfig without_hardware = device.actuator;
    without_hardware.driver = vm::DriverId::virtual_actuator;
    CHECK(result.image.empty() != without_hardware.moves_at_a_speed());
    found += result.image.empty() ? 0 : 1;
  }
  CHECK(found > 0);
}

TEST_CASE(
    "a servo's pulses cost an image nothing where they are the usual ones, or the servo is "
    "virtual") {
  const auto image_with = [](const std::string& type, const std::string& pulse) {
    const Result result =
        compile_text("AT START DO\n  MOVE it TO 20deg\nEND\n",
                     R"({"actuators": [{"name": "it", "device": "servo", )" + type + pulse + "}]}");
    INFO(messages(result));
    REQUIRE(!result.image.empty());
    return result.image;
  };
  const std::string on_pin = R"("type": "PWM", "pin": 10)";
  const auto plain = image_with(on_pin, "");
  CHECK(image_with(on_pin, R"(, "pulse": ["0.5ms", "2500us"])") == plain);
  CHECK(image_with(on_pin, R"(, "pulse": ["0.6ms", "2500us"])").size() == plain.size() + 4);
  CHECK(image_with(on_pin, R"(, "pulse": ["2.4ms", "600us"])").size() == plain.size() + 8);
  const std::string nowhere = R"("type": "VIRTUAL")";
  CHECK(image_with(nowhere, R"(, "pulse": ["0.6ms", "2.4ms"])") == image_with(nowhere, ""));
}

// BY of another kind than TO is no way that could be gone from where the actuator is.
TEST_CASE("a verb whose BY has a unit of its own moves nothing TO a place") {
  std::size_t found = 0;
  for (const DeviceText& text : device_texts()) {
    Diagnostics diagnostics;
    const Device device = read_device(text, diagnostics);
    for (const VerbConfig& verb : device.actuator.verbs) {
      if (verb.by_unit == nullptr) continue;
      ++found;
      INFO(device.name << " " << verb.name);
      CHECK(verb.has(vm::Param::by));
      CHECK_FALSE(verb.has(vm::Param::to));
      CHECK(verb.action == vm::Action::play);
      CHECK(&param_unit(device.actuator, vm::Param::by, &verb) == verb.by_unit);
      CHECK(&param_unit(device.actuator, vm::Param::by) == device.actuator.to_unit);
    }
  }
  CHECK(found == 3);
}

TEST_CASE("there is a generic virtual device of both kinds") {
  REQUIRE(default_device("VIRTUAL", true) != nullptr);
  REQUIRE(default_device("VIRTUAL", false) != nullptr);
  CHECK(default_device("VIRTUAL", true)->sensor.driver == vm::DriverId::virtual_sensor);
  CHECK(default_device("VIRTUAL", false)->actuator.driver == vm::DriverId::virtual_actuator);
}

TEST_CASE("a device says how it is wired: \"type\" need not") {
  const auto robot = [](const std::string& sensor_type, const std::string& actuator_type) {
    return compile_text("WHEN knob POSITION IS pressed\nDO MOVE arm TO 10deg\nEND\n",
                        R"({"sensors": [{"name": "knob", )" + sensor_type +
                            R"("pin": 40, "device": "button"}], "actuators": [{"name": "arm", )" +
                            actuator_type + R"("pin": 3, "device": "servo"}]})");
  };
  const auto with = robot(R"("type": "GPIO", )", R"("type": "PWM", )");
  const auto without = robot("", "");
  REQUIRE(!with.image.empty());
  CHECK(without.image == with.image);
}

TEST_CASE("a device without an address has the one that it is delivered with") {
  const auto robot = [](std::string near, std::string face, std::string arm) {
    return compile_text(
        "WHEN near DISTANCE < 9cm DO\n  SHOW face happy\n  MOVE arm TO 10deg\nEND\n",
        R"({"sensors": [{"name": "near", )" + near + R"("device": "vl53l0x"}], "actuators": [
        {"name": "face", )" +
            face + R"("device": "ssd1306"},
        {"name": "arm", )" +
            arm + R"("channel": 0, "enable": 36, "device": "pca9685_servo"}]})");
  };
  const Result with =
      robot(R"("address": "0x29", )", R"("address": "0x3c", )", R"("address": "0x40", )");
  INFO(messages(with));
  REQUIRE(!with.image.empty());
  CHECK(robot("", "", "").image == with.image);
}

TEST_CASE("a device that may be delivered with several addresses needs one") {
  const Result result = compile_text("", R"({"sensors": [{"name": "warm", "device": "tmp421"}]})");
  CHECK(messages(result).find("needs the key `address`") != std::string::npos);
}

TEST_CASE("a board without analog inputs says so, and which boards have some") {
  SourceMap sources;
  Diagnostics diagnostics;
  const FileId file =
      sources.add("robot.json", R"({"name": "grip", "type": "ADC", "pin": 3, "device": "force"})");
  const auto entry = json::read(sources, file, diagnostics);
  Board board = board_at(0);
  board.name = "plain";
  board.analog.clear();
  WiringReader wiring(board, diagnostics);
  REQUIRE(read_sensor(*entry, wiring, diagnostics));
  REQUIRE(diagnostics.errors() == 1);
  const std::string said = render_json(diagnostics, sources);
  CHECK_THAT(said, Catch::Contains("the board plain has no analog inputs"));
  CHECK_THAT(said, Catch::Contains("boards that have some: `b-l475e-iot01a`, `microbit-v2`, "
                                   "`mps2-an386` and `nucleo-l476rg`"));
}

TEST_CASE("the formats of a register on SPI are those of the schema, and reach the image") {
  const auto& formats = described(Object::sensor).at("properties").at("format").at("enum");
  REQUIRE(formats.size() == static_cast<std::size_t>(vm::SpiFormat::count_));
  for (std::size_t i = 0; i < formats.size(); ++i) {
    INFO(formats[i]);
    const auto made = compile_text(
        "WHEN heat LEVEL > 3 DO LOG \"hot\" END\n",
        R"({"sensors": [{"name": "heat", "type": "SPI", "pin": 36, "register": 200, "format": )" +
            formats[i].dump() + "}]}");
    REQUIRE_FALSE(made.image.empty());
    vm::Image image;
    REQUIRE(vm::view_image(made.image, image));
    const vm::Sensor& sensor = image.sensors[0];
    CHECK(sensor.driver == vm::DriverId::spi_register);
    CHECK(sensor.first_input == i);
    CHECK(sensor.address == 36);
    CHECK(image.channels[0].input == 200);
  }
}

TEST_CASE("what is built in of devices and boards is what their files say") {
  const auto in = [](const char* folder, std::string_view name) {
    const auto path = source_folder() / "stdlib" / folder / (std::string(name) + ".json");
    return nlohmann::ordered_json::parse(read_file(path));
  };
  for (const DeviceText& text : device_texts())
    CHECK(nlohmann::ordered_json::parse(text.json) == in("devices", text.name));
  for (const BoardText& text : board_texts())
    CHECK(nlohmann::ordered_json::parse(text.json) == in("boards", text.name));
}

TEST_CASE("the schema bounds a robot's name as the image does") {
  CHECK(schema().at("properties").at("name").at("maxLength") == vm::kMaxRobotName);
}

TEST_CASE("the schema has exactly the reader's keys") {
  for (const Object object : {Object::robot, Object::sensor, Object::channel, Object::actuator,
                              Object::trim, Object::sound, Object::limits, Object::behavior,
                              Object::scheduler, Object::safety, Object::algorithm}) {
    std::set<std::string> keys;
    for (const auto& [key, value] : described(object).at("properties").items())
      keys.insert(key);
    CHECK(keys == keys_of(object));
    CHECK(described(object).at("additionalProperties") == false);
  }
}

// ROBOSYNC_UPDATE_GOLDEN=1 writes them into the schema.
TEST_CASE("the schema lists the boards, types, devices, modules and units that the reader knows") {
  using Json = nlohmann::ordered_json;
  const auto path = source_folder() / "grammar/robot.schema.json";
  Json wanted = Json::parse(read_file(path));
  Json& definitions = wanted.at("definitions");
  const auto list = [](Json& object, const char* property) -> Json& {
    return object.at("properties").at(property).at("enum") = Json::array();
  };
  Json& boards = list(wanted, "board");
  for (const std::string_view name : board_names())
    boards.push_back(name);
  Json& sensor_types = list(definitions.at("sensor"), "type");
  Json& actuator_types = list(definitions.at("actuator"), "type");
  for (const WiringType& type : wiring_types()) {
    if (type.for_sensors) sensor_types.push_back(type.name);
    if (type.for_actuators) actuator_types.push_back(type.name);
  }
  Json& sensor_devices = list(definitions.at("sensor"), "device");
  Json& actuator_devices = list(definitions.at("actuator"), "device");
  for (const DeviceText& device : device_texts())
    (device.is_sensor ? sensor_devices : actuator_devices).push_back(device.name);
  // Who names a part of a board need not say how it is wired.
  const auto typeless = [&](const char* kind) -> Json& {
    return definitions.at(kind).at("anyOf").at(1).at("properties").at("device").at("enum") =
               Json::array();
  };
  Json &sensor_parts = typeless("sensor"), &actuator_parts = typeless("actuator");
  for (const auto& [part, is_sensor] : parts_of_boards()) {
    (is_sensor ? sensor_parts : actuator_parts).push_back(part);
    if (find_device(part, is_sensor) == nullptr)
      (is_sensor ? sensor_devices : actuator_devices).push_back(part);
  }
  Json& colors = list(definitions.at("actuator"), "color");
  for (const std::string_view color : panel_colors())
    colors.push_back(color);
  Json& modules = list(definitions.at("algorithm"), "module");
  for (const auto& where :
       {tool::algorithm_modules().firmware, tool::algorithm_modules().companion})
    for (const AlgorithmModule& module : where)
      if (std::find(modules.begin(), modules.end(), module.name) == modules.end())
        modules.push_back(module.name);
  Json& unit_names = list(definitions.at("channel"), "unit");
  for (const Unit& unit : units())
    unit_names.push_back(unit.spelling);
  robosync::testing::expect_golden(path, wanted.dump(2) + "\n");
}

TEST_CASE("the examples use only what the schema has") {
  for (const auto& entry : std::filesystem::directory_iterator(source_folder() / "examples")) {
    const auto path = entry.path() / "robot.json";
    if (!std::filesystem::exists(path)) continue;
    INFO(path);
    const auto robot = nlohmann::json::parse(read_file(path));
    check_keys(robot, Object::robot);
    for (const auto& sensor : robot.value("sensors", nlohmann::json::array())) {
      check_keys(sensor, Object::sensor);
      for (const auto& channel : sensor.value("channels", nlohmann::json::object()))
        check_keys(channel, Object::channel);
    }
    for (const auto& actuator : robot.value("actuators", nlohmann::json::array()))
      check_keys(actuator, Object::actuator);
  }
}

TEST_CASE("the boards are read without a mistake") {
  for (const BoardText& text : board_texts()) {
    INFO(text.name);
    Diagnostics diagnostics;
    const Board board = read_board(text, diagnostics);
    CHECK(diagnostics.all().empty());
    CHECK(nlohmann::json::parse(text.json).at("name") == std::string(text.name));
    CHECK(board.arena_bytes > 0);
    // Stacks stand at its end, those of algorithms first, which are regions of the MPU.
    CHECK((board.arena_begin + board.arena_bytes) % 512 == 0);
    CHECK(board.step_budget > 0);
    CHECK_FALSE(board.outputs.empty());
    for (std::uint16_t pin = 0; pin < 200; ++pin) {
      INFO(pin);
      // Only this board lets go of a pin (boards::Board::let_go()); the pin of an echo cannot be let go.
      if (board.name != "microbit-v2") CHECK_FALSE((board.has_output(pin) && board.has_input(pin)));
      if (board.has_echo(pin)) CHECK((board.has_input(pin) && !board.has_output(pin)));
    }
    for (const Board::Part& part : board.parts) {
      INFO(part.name);
      const Device* sensor = find_device(part.device, true);
      const Device* actuator = find_device(part.device, false);
      REQUIRE((sensor != nullptr || actuator != nullptr));
      if (sensor != nullptr && vm::is_on_i2c(sensor->sensor.driver))
        CHECK((part.bus < board.i2c_buses && part.address >= vm::kFirstAddress));
      else if (sensor != nullptr && vm::is_of_board(sensor->sensor.driver))
        CHECK_FALSE(part.pin);
      else if (sensor != nullptr)
        CHECK((part.pin && board.has_input(*part.pin)));
      if (actuator != nullptr) {
        const vm::DriverId driver = actuator->actuator.driver;
        CHECK((vm::drives_lights(driver) || vm::drives_speaker(driver)));
        CHECK_FALSE(part.pin);
      }
      // Else nobody could say which one is meant. These can only be the board's.
      if (sensor != nullptr && vm::is_of_board(sensor->sensor.driver)) {
        CHECK(part.name == part.device);
        continue;
      }
      CHECK(find_device(part.name, true) == nullptr);
      CHECK(find_device(part.name, false) == nullptr);
    }
  }
  CHECK(std::ranges::count(board_names(), default_board().name) == 1);
  std::set<unsigned> ids;
  for (const std::string_view name : board_names())
    CHECK(ids.insert(board_id(name)).second);
  CHECK(ids.count(0) == 0);
}

TEST_CASE("mistakes in a board's profile are reported") {
  Diagnostics missing;
  (void)read_board({"none", R"({"name": "none", "arena": {"begin": 0}})"}, missing);
  CHECK(missing.errors() == 7);  // no bytes, step_budget, I2C and SPI buses, lines, outputs, inputs
  Diagnostics misspelt;          // what nobody knows may be one of those, but for the bytes
  (void)read_board({"none", R"({"name": "none", "arena": {"begin": 0}, "flesh": 1})"}, misspelt);
  CHECK(misspelt.errors() == 2);
}

TEST_CASE("what parts are called elsewhere is no device here, and leads to one") {
  const auto is_device = [](std::string_view name) {
    return find_device(name, true) != nullptr || find_device(name, false) != nullptr;
  };
#define COMMON_DEVICE(name, device) \
  {                                 \
    INFO(name);                     \
    CHECK_FALSE(is_device(name));   \
    CHECK(is_device(device));       \
  }
#include "compiler/config/common_devices.def"
#undef COMMON_DEVICE
}

// Each key of each kind, with a letter too much: what the message suggests must be one that the device takes.
TEST_CASE("a key is suggested only for a device that has it") {
  std::size_t suggested = 0;
  for (const DeviceText& text : device_texts())
    for (const Key& key : known_keys()) {
      if (key.object != (text.is_sensor ? Object::sensor : Object::actuator)) continue;
      const std::string list = text.is_sensor ? "sensors" : "actuators";
      const nlohmann::json part = {
          {"name", "x"}, {"device", text.name}, {std::string(key.name) + "x", 1}};
      std::string robot = nlohmann::json{{list, {part}}}.dump();
      const Result misspelt = compile_text("", robot);
      for (const Diagnostic& one : misspelt.diagnostics.all()) {
        if (one.code != Code::E0202 || one.fixes.empty()) continue;
        const Fix& fix = one.fixes.front();
        robot.replace(fix.span.begin, fix.span.end - fix.span.begin, fix.replacement);
        ++suggested;
        break;
      }
      const std::string said = messages(compile_text("", robot));
      INFO(robot);
      CHECK_THAT(said, !Catch::Contains(" has no `") && !Catch::Contains("only a"));
    }
  CHECK(suggested > 100);
}
