// What robot.json may say under "algorithms": the modules that a robot's firmware has, those in files, and those that run on a
// computer beside the robot. Who compiles hands them in.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "vm/image.hpp"

namespace robosync::compiler {

struct ModuleInput {
  std::string name;
  std::optional<vm::Dimension> dimension;  // nothing: any
};

struct ModuleOutput {
  std::string name;  // of the channel
  vm::Dimension dimension{};
  vm::Value min = 0, max = 0;
  std::vector<std::string> labels;  // as in ChannelConfig
  bool learns_words = false;        // likewise
  bool is_taught =
      false;  // behind its labels come the words of a file, which robot.json names as "words"
};

struct ModuleParameter {
  std::string name;
  std::optional<vm::Dimension> dimension;  // nothing: the unit of the first input
  vm::Value usual = 0;                     // where robot.json says nothing
  vm::Value min = 0, max = 0;
};

struct AlgorithmModule {
  std::string name;
  std::vector<ModuleInput> inputs;  // at least one, of a module that runs on the board
  std::vector<ModuleOutput> outputs;
  std::vector<ModuleParameter> parameters;
  std::uint16_t shortest_period_ms = 0, longest_period_ms = 0;
  std::uint16_t usual_period_ms = 0;  // of an input that is fed, where robot.json says none
  // What it reads of the computer beside the robot, on which it runs: "camera". Empty: it runs on the board.
  std::string device{};
};

struct ModuleInFile {
  const AlgorithmModule* module = nullptr;  // until the next file is asked for
  std::uint8_t number = 0;                  // in the image
  std::string why_not;                      // where there is no module
};

struct WordsInFile {
  std::vector<std::string> words;
  std::string why_not;  // where there are none: what is wrong, about the file
};

struct AlgorithmModules {
  std::span<const AlgorithmModule> firmware;  // the number in the image is the place in the list
  ModuleInFile (*in_file)(const std::string& path) = nullptr;  // null: nobody loads files
  std::span<const AlgorithmModule> companion;                  // these have a device
  // Null: nobody reads them; then any word that a program compares with is taken for one of them.
  WordsInFile (*words_in_file)(const std::string& path) = nullptr;
};

}  // namespace robosync::compiler
