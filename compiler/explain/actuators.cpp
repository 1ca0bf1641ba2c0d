// May assume any tree of the parser: DEFINEs that run themselves are walked once.
#include "compiler/explain/actuators.hpp"

#include <algorithm>
#include <iterator>

#include <fmt/format.h>

#include "compiler/syntax/walk.hpp"

namespace robosync::compiler::explain {
namespace {

class Walk {
public:
  Walk(const Defines& defines, const Robot* robot) : defines_(defines), robot_(robot) {}

  void block(const ast::Block& block) {
    for (const ast::Stmt& stmt : block)
      std::visit([this](const auto& node) { visit(node); }, stmt.node);
  }
  ActuatorNames names;

private:
  void visit(const ast::Command& node) {
    if (node.arguments.empty() && run(node.verb.text)) return;
    for (const ast::Argument& argument : node.arguments) {
      const auto* const word = std::get_if<ast::Word>(&argument.value);
      if (word == nullptr || argument.preposition != ast::Preposition::none) continue;
      if (add(word->name.text)) return;
    }
    add_by_verb(node.verb.text);
  }
  void visit(const ast::Call& node) { run(node.name.text); }
  void visit(const ast::Stop& node) {
    if (node.name) {
      add(node.name->text);
    } else if (robot_ != nullptr) {
      for (const ActuatorConfig& actuator : robot_->actuators)
        names.insert(actuator.name.text);
    }
  }
  template <typename Other>
  void visit(const Other& node) {  // commands nothing by itself
    ast::for_each_block_of(node, [this](const ast::Block& inner) { block(inner); });
  }

  bool run(const std::string& name) {
    const auto found = defines_.find(folded(name));
    if (found == defines_.end()) return false;
    if (seen_.insert(found->second).second) block(found->second->body);
    return true;
  }

  // Without a robot, the first word of a command is its actuator.
  bool add(const std::string& name) {
    if (robot_ == nullptr) return names.insert(name), true;
    for (const ActuatorConfig& actuator : robot_->actuators) {
      if (folded(actuator.name.text) == folded(name)) {
        return names.insert(actuator.name.text), true;
      }
    }
    for (const GroupConfig& group : robot_->groups) {
      if (folded(group.name.text) != folded(name)) continue;
      for (const std::size_t member : group.members)
        names.insert(robot_->actuators[member].name.text);
      return true;
    }
    return false;
  }

  // SAY "…" names none: it is the one that knows the verb.
  void add_by_verb(const std::string& verb) {
    if (robot_ == nullptr) return;
    for (const ActuatorConfig& actuator : robot_->actuators) {
      if (std::ranges::any_of(actuator.verbs, [&](const VerbConfig& known) {
            return folded(known.name) == folded(verb);
          })) {
        names.insert(actuator.name.text);
      }
    }
  }

  const Defines& defines_;
  const Robot* robot_;
  std::set<const ast::Define*> seen_;
};

std::string named(const Party& party) {
  return party.priority >= 1 ? fmt::format("{} (priority {})", party.name, party.priority)
                             : party.name;
}

bool share(const Party& a, const Party& b) {
  return std::ranges::any_of(a.actuators,
                             [&](const std::string& name) { return b.actuators.contains(name); });
}

}  // namespace

ActuatorNames actuators_of(const ast::Block& block, const Defines& defines, const Robot* robot) {
  Walk walk(defines, robot);
  walk.block(block);
  return std::move(walk.names);
}

std::vector<std::string> meetings(const Party& party, const std::vector<Party>& parties) {
  std::vector<std::string> above;
  std::vector<std::string> below;
  for (const Party& other : parties) {
    if (&other == &party || !share(party, other)) continue;
    (other.priority > party.priority ? above : below).push_back(named(other));
  }
  std::vector<std::string> lines;
  if (!below.empty()) lines.push_back(fmt::format("It interrupts {}.", list(below)));
  if (!above.empty()) {
    lines.push_back(fmt::format("It is interrupted by {}.", list(above)));
  }
  return lines;
}

std::string list(const std::vector<std::string>& words) {
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (i > 0) text += i + 1 == words.size() ? " and " : ", ";
    text += words[i];
  }
  return text;
}

}  // namespace robosync::compiler::explain
