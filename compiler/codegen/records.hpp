// The records of devices and variables: everything in the image apart from rules and code.
#pragma once

#include <optional>
#include <vector>

#include "compiler/codegen/tables.hpp"

namespace robosync::compiler {

struct Records {
  std::vector<vm::Sensor> sensors;
  std::vector<vm::Channel> channels;
  std::vector<vm::Actuator> actuators;
  std::vector<vm::Group> groups;
  std::vector<vm::Verb> verbs;
  std::vector<vm::WordEntry> words;
  std::vector<vm::Variable> variables;
  std::vector<vm::Check> checks;
  std::vector<vm::Band> bands;
  std::vector<vm::Adaptation> adaptations;
  std::vector<vm::Trait> traits;
  std::vector<vm::Motion> motions;
  std::vector<vm::Track> tracks;
  std::vector<vm::Key> keys;
  std::optional<vm::DriveParameters> drive;
};

// Adds names and labels to `strings`.
[[nodiscard]] Records make_records(const ir::Program& program, const Robot& robot,
                                   const Tables& tables, Strings& strings);

}  // namespace robosync::compiler
