// Accepts any tree of the parser. A DEFINE that runs itself is walked once.
#include "compiler/explain/actuators.hpp"

#include <algorithm>
#include <iterator>
#include <map>
#include <utility>

#include <fmt/format.h>

#include "compiler/source/ascii.hpp"
#include "compiler/syntax/walk.hpp"

namespace robosync::compiler::explain {
namespace {

using Given = std::map<std::string, std::string>;  // the names given as arguments, by parameter

class Walk {
public:
  Walk(Trees trees, const Defines& defines, const Robot* robot)
      : trees_(trees), defines_(defines), robot_(robot) {}

  void block(const ast::Block& block) {
    for (const ast::Stmt& stmt : block)
      std::visit([this](const auto& node) { visit(node); }, stmt.node);
  }
  [[nodiscard]] const ActuatorNames& names() const { return names_; }
  [[nodiscard]] const std::set<std::pair<const ast::Define*, Given>>& seen() const { return seen_; }

private:
  void visit(const ast::Command& node) {
    if (node.arguments.empty() && run(node.verb.text, {})) return;
    for (const ast::Argument& argument : node.arguments) {
      const auto* const word = std::get_if<ast::Word>(&argument.value);
      if (word == nullptr || argument.preposition != ast::Preposition::none) continue;
      if (ascii::same(node.verb.text, "PERFORM") && add_motion(word->name.text)) return;
      if (add(word->name.text)) return;
    }
    add_by_verb(node.verb.text);
  }
  void visit(const ast::Call& node) { run(node.name.text, node.arguments); }
  void visit(const ast::Stop& node) {
    if (node.name) {
      add(node.name->text);
    } else if (robot_ != nullptr) {
      for (const ActuatorConfig& actuator : robot_->actuators)
        names_.insert(actuator.name.text);
    }
  }
  template <typename Other>
  void visit(const Other& node) {  // commands nothing itself
    ast::for_each_block_of(node, [this](const ast::Block& inner) { block(inner); });
  }

  // The argument for a parameter of the DEFINE that is being walked.
  std::string meant(std::string_view name) const {
    const auto found = given_.find(folded(name));
    return found == given_.end() ? std::string(name) : found->second;
  }

  bool run(std::string_view name, const std::vector<ast::Argument>& arguments) {
    const auto found = defines_.find(folded(meant(name)));
    if (found == defines_.end()) return false;
    const ast::Define& define = *found->second;
    Given given;
    for (std::size_t i = 0; i < std::min(define.parameters.size(), arguments.size()); ++i)
      if (const std::string_view argument = named_by(arguments[i]); !argument.empty())
        given[folded(define.parameters[i].text)] = meant(argument);
    if (!seen_.insert({&define, given}).second) return true;
    std::swap(given, given_);
    block(define.body);
    std::swap(given, given_);
    return true;
  }

  static std::string_view named_by(const ast::Argument& argument) {
    const auto* const amount = std::get_if<ast::Amount>(&argument.value);
    if (amount == nullptr || amount->value == nullptr) return {};
    const auto* const operand = std::get_if<ast::Operand>(&amount->value->node);
    return operand == nullptr || operand->channel ? std::string_view() : operand->name.text;
  }

  // Without a robot, the first word of a command is its actuator.
  bool add(std::string_view written) {
    const std::string name = meant(written);
    if (robot_ == nullptr) return names_.insert(name), true;
    for (const ActuatorConfig& actuator : robot_->actuators) {
      if (ascii::same(actuator.name.text, name)) {
        return names_.insert(actuator.name.text), true;
      }
    }
    for (const GroupConfig& group : robot_->groups) {
      if (!ascii::same(group.name.text, name)) continue;
      for (const std::size_t member : group.members)
        names_.insert(robot_->actuators[member].name.text);
      return true;
    }
    return false;
  }

  // Adds all of its columns, because PERFORM claims them all together.
  bool add_motion(std::string_view name) {
    const ast::Motion* const motion = motion_called(name);
    if (motion == nullptr) return false;
    for (const ast::Name& column : motion->columns)
      add(column.text);
    return true;
  }

  const ast::Motion* motion_called(std::string_view name) const {
    for (const ast::Tree* const tree : trees_)
      for (const ast::Item& item : tree->items)
        if (const auto* const motion = std::get_if<ast::Motion>(&item.node);
            motion != nullptr && ascii::same(motion->name.text, name))
          return motion;
    return nullptr;
  }

  // SAY "…" names no actuator: the one that knows the verb is meant.
  void add_by_verb(std::string_view verb) {
    if (robot_ == nullptr) return;
    for (const ActuatorConfig& actuator : robot_->actuators) {
      if (std::ranges::any_of(actuator.verbs, [&](const VerbConfig& known) {
            return ascii::same(known.name, verb);
          })) {
        names_.insert(actuator.name.text);
      }
    }
  }

  Trees trees_;
  const Defines& defines_;
  const Robot* robot_;
  ActuatorNames names_;
  Given given_;
  std::set<std::pair<const ast::Define*, Given>> seen_;
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

void add_used(const ast::Block& block, Trees trees, const Defines& defines, const Robot* robot,
              Used& used) {
  Walk walk(trees, defines, robot);
  walk.block(block);
  used.actuators.insert(walk.names().begin(), walk.names().end());
  for (const auto& [define, given] : walk.seen())
    used.defines.insert(define);
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
