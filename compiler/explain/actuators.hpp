// Who uses which actuators, found from the tree alone and, where there is one, the robot: what
// interrupts what.
#pragma once

#include <set>
#include <string>
#include <vector>

#include "compiler/config/robot.hpp"
#include "compiler/explain/statements.hpp"
#include "compiler/syntax/ast.hpp"

namespace robosync::compiler::explain {

// Names of actuators; of a group, its members. Without a robot, the names in the program.
using ActuatorNames = std::set<std::string>;

// `trees` have the MOTIONs that PERFORM may mean. `robot` may be null.
[[nodiscard]] ActuatorNames actuators_of(const ast::Block& block, Trees trees,
                                         const Defines& defines, const Robot* robot);

// A behaviour, or a rule outside one.
struct Party {
  std::string name;  // as it is said: "greet", "the rule at line 3"
  int priority = 0;  // below 1: a rule outside a BEHAVIOR without PRIORITY
  ActuatorNames actuators;
};

// "It interrupts rest (priority 10) …", a line each; empty when it meets nobody.
[[nodiscard]] std::vector<std::string> meetings(const Party& party,
                                                const std::vector<Party>& parties);

// "a", "a and b", "a, b and c".
[[nodiscard]] std::string list(const std::vector<std::string>& words);

}  // namespace robosync::compiler::explain
