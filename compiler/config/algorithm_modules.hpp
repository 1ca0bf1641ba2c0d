// What robot.json may say under "algorithms": the modules that a robot's firmware has, and those in files. Who compiles hands them
// in.
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
};

struct ModuleParameter {
  std::string name;
  std::optional<vm::Dimension> dimension;  // nothing: the unit of the first input
  vm::Value usual = 0;                     // where robot.json says nothing
  vm::Value min = 0, max = 0;
};

struct AlgorithmModule {
  std::string name;
  std::vector<ModuleInput> inputs;  // at least one
  std::vector<ModuleOutput> outputs;
  std::vector<ModuleParameter> parameters;
  std::uint16_t shortest_period_ms = 0, longest_period_ms = 0;
  std::uint16_t usual_period_ms = 0;  // of an input that is fed, where robot.json says none
};

struct ModuleInFile {
  const AlgorithmModule* module = nullptr;  // until the next file is asked for
  std::uint8_t number = 0;                  // in the image
  std::string why_not;                      // where there is no module
};

struct AlgorithmModules {
  std::span<const AlgorithmModule> firmware;  // the number in the image is the place in the list
  ModuleInFile (*in_file)(const std::string& path) = nullptr;  // null: nobody loads files
};

}  // namespace robosync::compiler
