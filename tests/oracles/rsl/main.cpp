// reference PROGRAM.rsl ROBOT.json SCENARIO.json END_MS SEED: the trace of a program, as the
// language says it must be. The seed is the one that `rsc run` says in its first event.
#include <algorithm>
#include <fstream>
#include <iostream>
#include <sstream>
#include <stdexcept>

#include <nlohmann/json.hpp>

#include "compiler/units/units.hpp"
#include "tests/oracles/rsl/analysed.hpp"

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

std::vector<oracle::Reading> scenario(const std::string& file, const oracle::Analysed& robot) {
  std::vector<oracle::Reading> result;
  const Json root = Json::parse(read(file));
  for (const Json& stimulus : root.at("stimuli")) {
    const auto text = [&](const char* key) { return stimulus.at(key).get<std::string>(); };
    result.push_back({quantity(text("at")), robot.channel(text("sensor"), text("channel")),
                      quantity(text("value"))});
  }
  std::stable_sort(result.begin(), result.end(),
                   [](const auto& a, const auto& b) { return a.at < b.at; });
  return result;
}

void run(const std::vector<std::string>& arguments) {
  const oracle::Analysed analysed(arguments[0], read(arguments[0]), read(arguments[1]));
  oracle::Trace trace(std::cout, analysed.program(), analysed.robot());
  const auto seed = static_cast<std::uint32_t>(std::stoll(arguments[4]));
  oracle::Interpreter interpreter(analysed.program(), analysed.robot(), seed, trace);
  interpreter.run(scenario(arguments[2], analysed), std::stoll(arguments[3]));
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
