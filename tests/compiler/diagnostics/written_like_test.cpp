// What is shown as the right way to write a line is right: each example that the names of a robot give is compiled.
#include <catch2/catch.hpp>

#include "compiler/config/robot_reader.hpp"
#include "compiler/config/robot_vocabulary.hpp"
#include "tests/compiler/compiled.hpp"
#include "tests/compiler/syntax/examples.hpp"

using namespace robosync::compiler;
using namespace robosync::compiler::testing;
using Part = Vocabulary::Part;

namespace {

struct Pattern {
  Part part;
  std::string before, after;
};

const std::vector<Pattern> kPatterns = {
    {Part::condition, "WHEN ", " DO\n  LOG \"x\"\nEND\n"},
    {Part::reading, "TEST \"x\"\n  AT 1s ", "\nEND\n"},
    {Part::channel, "AT START DO\n  LOG \"x\", ", "\nEND\n"},
    {Part::actuator, "AT START DO\n  STOP ", "\nEND\n"},
    {Part::speed_limit, "LIMIT ", "\n"},
    {Part::followed, "WHILE x > 0 DO\n  FOLLOW ", "\nEND\nREMEMBER x = 0\n"},
};

std::vector<std::string> names_of(const Robot& robot) {
  std::vector<std::string> names{""};
  for (const SensorConfig& sensor : robot.sensors)
    names.push_back(sensor.name.text);
  for (const ActuatorConfig& actuator : robot.actuators)
    names.push_back(actuator.name.text);
  for (const GroupConfig& group : robot.groups)
    names.push_back(group.name.text);
  return names;
}

std::size_t check_right(const std::string& program, const std::string& configuration) {
  const Result result = compiled(program, configuration);
  INFO(program << messages(result));
  CHECK(result.diagnostics.errors() == 0);
  return 1;
}

std::size_t check_commands(const Robot& robot, const Vocabulary& vocabulary,
                           const std::string& configuration) {
  std::size_t checked = 0;
  for (const std::string& name : names_of(robot))
    for (const ActuatorConfig& actuator : robot.actuators)
      for (const VerbConfig& verb : actuator.verbs)
        for (const bool places : {false, true})
          if (const std::string command = vocabulary.command(verb.name, name, places);
              !command.empty())
            checked += check_right("AT START DO\n  " + command + "\nEND\n", configuration);
  return checked;
}

std::size_t check_robot(const std::string& configuration) {
  SourceMap sources;
  Diagnostics diagnostics;
  (void)sources.add("robot.rsl", "");
  const auto robot = read_robot(sources, sources.add("robot.json", configuration), diagnostics, {});
  if (!robot || !robot->complete) return 0;  // one with algorithms
  const RobotVocabulary vocabulary(*robot);
  std::size_t checked = check_commands(*robot, vocabulary, configuration);
  for (const std::string& name : names_of(*robot))
    for (const auto& [part, before, after] : kPatterns)
      if (const std::string text = vocabulary.part(part, name); !text.empty())
        checked += check_right(before + text + after, configuration);
  return checked;
}

}  // namespace

TEST_CASE("a line that is shown as an example compiles") {
  std::size_t checked = check_robot(common_robot());
  checked += check_robot(read_file(source_folder() / "docs/robot.json"));
  for (const Example& example : examples())
    checked += check_robot(example.robot);
  CHECK(checked > 300);
}
