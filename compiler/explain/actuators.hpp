// Finds which rules use which actuators, and which ones interrupt each other. Works on the tree alone, and on the robot if there
// is one.
#pragma once

#include <set>
#include <string>
#include <vector>

#include "compiler/config/robot.hpp"
#include "compiler/explain/statements.hpp"
#include "compiler/syntax/ast.hpp"

namespace robosync::compiler::explain {

// Names of actuators; for a group, its members. Without a robot, the names in the program.
using ActuatorNames = std::set<std::string>;

// What a response uses, also in the DEFINEs that it does.
struct Used {
  ActuatorNames actuators;
  std::set<const ast::Define*> defines;
};

// Adds what `block` uses. `trees` contain the MOTIONs that PERFORM can name. `robot` may be null.
void add_used(const ast::Block& block, Trees trees, const Defines& defines, const Robot* robot,
              Used& used);

// A behaviour, or a rule outside one.
struct Party {
  std::string name;  // as shown: "greet", "the rule at line 3"
  int priority = 0;  // below 1: a rule outside a BEHAVIOR without PRIORITY
  ActuatorNames actuators;
};

// "It interrupts rest (priority 10) …", one line each; empty if it shares no actuator with another party.
[[nodiscard]] std::vector<std::string> meetings(const Party& party,
                                                const std::vector<Party>& parties);

// "a", "a and b", "a, b and c".
[[nodiscard]] std::string list(const std::vector<std::string>& words);

}  // namespace robosync::compiler::explain
