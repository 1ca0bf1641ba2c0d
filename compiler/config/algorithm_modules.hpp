// What robot.json may name under "algorithms": the modules of the robot's firmware, modules in files, and modules that run on a
// companion computer. The caller of the compiler supplies them.
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
  std::optional<vm::Dimension> dimension;  // nullopt: any
};

struct ModuleOutput {
  std::string name;  // of the channel
  vm::Dimension dimension{};
  vm::Value min = 0, max = 0;
  std::vector<std::string> labels;  // as in ChannelConfig
  bool learns_words = false;        // as in ChannelConfig
  bool is_taught = false;  // robot.json names a file of "words", which are added after its labels
};

struct ModuleParameter {
  std::string name;
  std::optional<vm::Dimension> dimension;  // nullopt: the unit of the first input
  vm::Value usual = 0;                     // if robot.json gives no value
  vm::Value min = 0, max = 0;
  bool is_whole = false;  // takes no decimals
};

struct AlgorithmModule {
  std::string name;
  std::vector<ModuleInput> inputs;  // at least one if the module runs on the board
  std::vector<ModuleOutput> outputs;
  std::vector<ModuleParameter> parameters;
  std::uint16_t shortest_period_ms = 0, longest_period_ms = 0;
  std::uint16_t usual_period_ms = 0;  // without a rate: on a companion, or for a fed input
  std::uint8_t room = 0;              // on the board: vm::Sensor::room
  std::size_t most_constants = 0;     // on the board: what it may be taught; 0: nothing
  // The device of the companion computer that the module reads: "camera". Empty: the module runs on the board.
  std::string device{};
};

struct ModuleInFile {
  const AlgorithmModule* module = nullptr;  // valid until the next file is loaded
  std::uint8_t number = 0;                  // in the image
  std::string why_not;                      // if there is no module
};

struct WordsInFile {
  std::vector<std::string> words;
  std::string why_not;                 // if there are no words: what is wrong with the file
  std::vector<vm::Value> constants{};  // of the words, for a module on the board
};

struct AlgorithmModules {
  std::span<const AlgorithmModule> firmware;  // the index is the module's number in the image
  ModuleInFile (*in_file)(const std::string& path) = nullptr;  // null: the caller loads no files
  std::span<const AlgorithmModule> companion;                  // these have a device
  // Null: the caller reads no files of words. Then every word that a program compares with is accepted.
  WordsInFile (*words_in_file)(const std::string& path) = nullptr;
};

}  // namespace robosync::compiler
