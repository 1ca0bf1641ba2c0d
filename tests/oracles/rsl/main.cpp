// reference PROGRAM.rsl ROBOT.json SCENARIO.json END_MS SEED: the trace of a program, as the
// language says it must be. The seed is the one that `rsc run` says in its first event.
#include <fstream>
#include <iostream>
#include <sstream>
#include <stdexcept>

#include <nlohmann/json.hpp>

#include "compiler/config/robot_reader.hpp"
#include "compiler/diagnostics/render.hpp"
#include "compiler/modules.hpp"
#include "compiler/sema/analyze.hpp"
#include "compiler/syntax/parser.hpp"
#include "tests/oracles/rsl/interpreter.hpp"

namespace {

using namespace robosync;
using Json = nlohmann::json;

std::string read(const std::string& file) {
  std::ifstream stream(file);
  if (!stream) throw std::runtime_error(file + " cannot be read");
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

std::int64_t quantity(const std::string& text) {
  const std::size_t digits = std::min(text.find_first_not_of("+-.0123456789"), text.size());
  const auto number = compiler::parse_decimal(std::string_view(text).substr(0, digits));
  const compiler::Unit* const unit = compiler::find_unit(text.substr(digits));
  const auto value = number && unit != nullptr ? compiler::to_value(*number, *unit) : std::nullopt;
  if (!value) throw std::runtime_error("`" + text + "` is no quantity");
  return *value;
}

compiler::ChannelRef channel(const compiler::Robot& robot, const Json& stimulus) {
  for (std::size_t s = 0; s < robot.sensors.size(); ++s) {
    if (robot.sensors[s].name.text != stimulus.at("sensor")) continue;
    for (std::size_t c = 0; c < robot.sensors[s].channels.size(); ++c)
      if (robot.sensors[s].channels[c].name.text == stimulus.at("channel")) return {s, c};
  }
  throw std::runtime_error("no such channel: " + stimulus.dump());
}

std::vector<oracle::Reading> scenario(const std::string& file, const compiler::Robot& robot) {
  std::vector<oracle::Reading> result;
  const Json root = Json::parse(read(file));
  for (const Json& stimulus : root.at("stimuli"))
    result.push_back(
        {quantity(stimulus.at("at")), channel(robot, stimulus), quantity(stimulus.at("value"))});
  std::stable_sort(result.begin(), result.end(),
                   [](const auto& a, const auto& b) { return a.at < b.at; });
  return result;
}

void run(const std::vector<std::string>& arguments) {
  compiler::SourceMap sources;
  compiler::Diagnostics diagnostics;
  const compiler::FileId text = sources.add(arguments[0], read(arguments[0]));
  const compiler::FileId config = sources.add(arguments[1], read(arguments[1]));
  const compiler::ast::Program tree = compiler::parse(sources, text, diagnostics);
  const auto modules = compiler::load_modules(tree, sources, {}, diagnostics);
  const auto robot = compiler::read_robot(sources, config, diagnostics);
  if (!robot || diagnostics.errors() > 0)
    throw std::runtime_error(compiler::render_human(diagnostics, sources, false));
  compiler::Trees trees{&tree};
  for (const compiler::Module& module : modules)
    trees.push_back(module.tree.get());
  const compiler::Program program = compiler::analyze(trees, *robot, sources, diagnostics);
  if (diagnostics.errors() > 0)
    throw std::runtime_error(compiler::render_human(diagnostics, sources, false));
  oracle::Trace trace(std::cout, program, *robot);
  const auto seed = static_cast<std::uint32_t>(std::stoll(arguments[4]));
  oracle::Interpreter interpreter(program, *robot, seed, trace);
  interpreter.run(scenario(arguments[2], *robot), std::stoll(arguments[3]));
}

}  // namespace

int main(int argc, char** argv) {
  const std::vector<std::string> arguments(argv + 1, argv + argc);
  if (arguments.size() != 5) {
    std::cerr << "usage: reference PROGRAM.rsl ROBOT.json SCENARIO.json END_MS SEED\n";
    return 2;
  }
  try {
    run(arguments);
    return 0;
  } catch (const std::exception& error) {
    std::cerr << error.what() << "\n";
    return 1;
  }
}
