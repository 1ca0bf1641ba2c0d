// rsc teach NAME WORD RECORDING... [--config robot.json] [--programs FOLDER]
// rsc teach NAME WORD --microphone DEV|FILE
// rsc teach NAME --forget WORD
// rsc teach NAME --list
#include <cerrno>
#include <cstring>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <unistd.h>

#include "compiler/source/ascii.hpp"
#include "rsc/companion/companion.hpp"
#include "rsc/failure.hpp"
#include "rsc/verb.hpp"

namespace robosync::tool {
namespace {

struct TeachOptions {
  std::string name, word, forget, microphone, programs, config = "robot.json";
  std::vector<std::string> recordings;
  bool list = false;
};

// The words themselves are not read: there may be none yet, and the module's program reports errors in them.
compiler::SensorConfig algorithm_of(const TeachOptions& options) {
  std::string known;
  for (const compiler::SensorConfig& sensor : algorithms_in(options.config, false)) {
    if (sensor.words_file.empty()) continue;
    if (compiler::ascii::same(sensor.name.text, options.name)) return sensor;
    known += (known.empty() ? "" : ", ") + sensor.name.text;
  }
  throw Failure(
      Exit::program,
      known.empty()
          ? fmt::format("{} has no algorithm that can be taught words: add {{\"name\": \"{}\", "
                        "\"module\": \"own_words\"}} to its \"algorithms\" (docs/algorithms.md)",
                        options.config, options.name)
          : fmt::format("{} has no `{}` that can be taught words; it has {}", options.config,
                        options.name, known));
}

// The arguments for the module's program.
std::vector<std::string> task(const TeachOptions& options) {
  const bool teaches = !options.word.empty();
  if (teaches + options.list + !options.forget.empty() != 1)
    throw Failure(Exit::usage,
                  "name a word to teach, or --list, or --forget a word: one of the three");
  if (options.list) return {"--list", "yes"};
  if (!teaches) return {"--forget", options.forget};
  if (options.word.find_first_of("./") != std::string::npos)
    throw Failure(Exit::usage, fmt::format("`{0}` is not a word: write rsc teach {1} WORD {0}",
                                           options.word, options.name));
  if (options.recordings.empty() == options.microphone.empty())
    throw Failure(Exit::usage, "give recordings of the word, or --microphone");
  std::vector<std::string> arguments = {"--teach", options.word};
  if (!options.microphone.empty())
    arguments.insert(arguments.end(), {"--source", options.microphone});
  for (const std::string& recording : options.recordings)
    arguments.insert(arguments.end(), {"--recording", recording});
  return arguments;
}

// The program replaces rsc: its output and exit code are those of rsc teach.
[[noreturn]] void become(const std::string& program, const std::vector<std::string>& arguments) {
  std::vector<char*> texts = {const_cast<char*>(program.c_str())};
  for (const std::string& argument : arguments)
    texts.push_back(const_cast<char*>(argument.c_str()));
  texts.push_back(nullptr);
  execv(program.c_str(), texts.data());
  throw Failure(Exit::outside, fmt::format("{}: {}", program, std::strerror(errno)));
}

void run(const TeachOptions& options) {
  std::vector<std::string> arguments = task(options);
  const compiler::SensorConfig algorithm = algorithm_of(options);
  arguments.insert(arguments.begin(), {"--words", algorithm.words_file});
  const std::string program = find_companion_program(algorithm.taught_by, options.programs);
  if (program.empty())
    throw Failure(Exit::outside, fmt::format("the program for the module {} is not installed: run "
                                             "scripts/companion (docs/companion.md)",
                                             algorithm.taught_by));
  become(program, arguments);
}

}  // namespace

void add_teach(Options& options) {
  auto asked = std::make_shared<TeachOptions>();
  options.argument("NAME", asked->name, "the algorithm in robot.json", Options::Need::required);
  options.argument("WORD", asked->word, "as the program calls it: a to z, digits and _",
                   Options::Need::optional);
  options.arguments("RECORDING", asked->recordings,
                    "three or more sound files, each with the word said once",
                    Options::Need::optional);
  options.option("--microphone", "DEV|FILE", asked->microphone,
                 "hear it three times from a microphone (see `arecord -L`) or a sound file");
  options.flag("--list", asked->list, "list the words it knows, and which sound alike");
  options.option("--forget", "WORD", asked->forget, "remove this word");
  options.option("--config", "FILE", asked->config, "robot.json; else the one in this folder");
  options.option("--programs", "FOLDER", asked->programs,
                 "where the modules' programs are; else beside rsc or on the PATH");
  options.runs([asked] { run(*asked); });
}

}  // namespace robosync::tool
