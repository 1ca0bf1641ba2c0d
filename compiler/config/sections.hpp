// The sections of robot.json besides sensors and actuators.
#pragma once

#include "compiler/config/json_reader.hpp"
#include "compiler/config/robot.hpp"

namespace robosync::compiler {

void read_groups(const json::Value& value, Robot& robot, Diagnostics& diagnostics);

// Reads the entries of "behaviors", after actuators and groups.
class BehaviorReader {
public:
  BehaviorReader(Robot& robot, Diagnostics& diagnostics);
  // Adds an entry to the robot. False when it has no name.
  [[nodiscard]] bool read(const json::Value& value);

private:
  Robot& robot_;
  NameIndex actuators_, groups_;
  Diagnostics& diagnostics_;
};

// "scheduler": what it does not say is as in the paper's example.
[[nodiscard]] SchedulerConfig read_scheduler(const json::Value& value, Diagnostics& diagnostics);

void read_safety(const json::Value& value, Robot& robot, Diagnostics& diagnostics);
void read_lints(const json::Value& value, Robot& robot, Diagnostics& diagnostics);
// Algorithms cannot be loaded by this version: checks the entry and says so.
void report_algorithm(const json::Value& value, Diagnostics& diagnostics);

}  // namespace robosync::compiler
