// Accepts any tree of the parser. Each part keeps the program's own order.
#include "compiler/explain/program_text.hpp"

#include <algorithm>
#include <charconv>
#include <set>

#include <fmt/format.h>

#include "compiler/explain/actuators.hpp"
#include "compiler/explain/conditions.hpp"
#include "compiler/explain/rules.hpp"
#include "compiler/units/units.hpp"

namespace robosync::compiler::explain {
namespace {

constexpr std::size_t kTextIndent = 2;

// Readers who know how rules are evaluated make fewer mistakes.
constexpr std::string_view kHowItWorks =
    "How the robot runs its rules:\n"
    "  - \"As soon as\" happens once, at the moment something becomes true, or at start if it is\n"
    "    already true. It must stop being true before it can happen again.\n"
    "  - \"While\" goes on for as long as something is true, and stops when it is not.\n"
    "  - Only one rule at a time uses an actuator: the one with the higher priority. It ends the\n"
    "    whole response of the other rule, which does not resume, except for a \"while\" that\n"
    "    is still true.\n"
    "  - A sensor without a reading is unknown: then rules do nothing, and safety rules stop.\n";

int to_number(const std::optional<ast::Name>& digits) {
  int number = 0;
  if (digits) {
    std::from_chars(digits->text.data(), digits->text.data() + digits->text.size(), number);
  }
  return number;
}

class Teller {
public:
  Teller(Trees trees, const SourceMap& sources, const Robot* robot)
      : trees_(trees), sources_(sources), robot_(robot), defines_(defines_of(trees)) {
    if (!trees.front()->items.empty()) own_file_ = trees.front()->items.front().span.file;
  }

  std::string tell() {
    find_parties();
    std::string memory;
    for_each_item([&](const ast::Item& item) {
      if (is_own(item) || keeps_something(item))
        memory += std::visit([&](const auto& node) { return remembered(node); }, item.node);
    });
    if (!memory.empty()) text_ += "\nNames:\n" + memory;
    tell_each<ast::Check>();
    tell_each<ast::Limit>();
    tell_each<ast::Safety>();
    for_each_item([&](const ast::Item& item) {
      if (const auto* node = std::get_if<ast::Behavior>(&item.node)) tell(*node, item.span);
      if (const auto* node = std::get_if<ast::Rule>(&item.node)) tell(*node, item.span);
    });
    tell_defines();
    tell_what_moves();
    return std::string(kHowItWorks) + text_;
  }

private:
  template <typename Do>
  void for_each_item(Do&& what) const {
    for (const ast::Tree* const tree : trees_)
      for (const ast::Item& item : tree->items)
        what(item);
  }
  template <typename Node>
  void tell_each() {
    for_each_item([&](const ast::Item& item) {
      if (const auto* node = std::get_if<Node>(&item.node)) tell(*node, item.span);
    });
  }

  // The DEFINEs of modules only if they are used, or the text would be a library's.
  void tell_defines() {
    for_each_item([&](const ast::Item& item) {
      const auto* const node = std::get_if<ast::Define>(&item.node);
      if (node != nullptr && (is_own(item) || used_defines_.contains(node))) tell(*node, item.span);
    });
  }

  // ---- the robot: what limits a movement, what ends it, and what lets the part go again
  static std::string_view state(vm::Release release, const ActuatorConfig& actuator) {
    if (release == vm::Release::hold) return "stays as it is";
    if (release == vm::Release::rest) return "goes to its rest position";
    const bool turns =
        actuator.to_unit != nullptr && actuator.to_unit->dimension == vm::Dimension::angle;
    return turns ? "goes limp" : "is off";
  }

  static std::string limits(const ActuatorConfig& actuator) {
    if (actuator.at_unit == nullptr) return {};
    std::string text;
    if (actuator.speed_limit != vm::kValueMax)
      text = fmt::format(" It goes no faster than {}.",
                         format_value(actuator.speed_limit, *actuator.at_unit));
    if (actuator.acceleration != 0)
      text += fmt::format(" Its speed changes by at most {}.",
                          format_acceleration(actuator.acceleration, *actuator.at_unit));
    return text;
  }

  void tell_what_moves() {
    if (robot_ == nullptr || std::ranges::none_of(robot_->actuators, &ActuatorConfig::moves))
      return;
    say(0, "\nWhat moves, as robot.json and LIMITs say:");
    for (const ActuatorConfig& actuator : robot_->actuators) {
      if (!actuator.moves()) continue;
      say(kTextIndent,
          fmt::format("{}:{} In a halt it {}; when its response ends, it {}.", actuator.name.text,
                      limits(actuator), state(actuator.safe, actuator),
                      state(actuator.on_release, actuator)));
    }
    say(kTextIndent,
        "A halt is a SAFETY rule, `rsc stop` or a fault. A SAFETY rule lets go as its RESUME "
        "says,\n"
        "  or, without one, when you upload a program; `rsc resume` lets go after the other two.");
  }

  bool is_own(const ast::Item& item) const { return item.span.file == own_file_; }
  static bool keeps_something(const ast::Item& item) {
    return std::holds_alternative<ast::Remember>(item.node) ||
           std::holds_alternative<ast::State>(item.node) ||
           std::holds_alternative<ast::Timer>(item.node) ||
           std::holds_alternative<ast::Feeling>(item.node);
  }

  // "line 3", "line 3 of manners.rsl"; modules of the library are called <gestures>.
  std::string place_of(Span span) const {
    const SourceFile& file = sources_.file(span.file);
    const std::string line = fmt::format("line {}", file.position(span.begin).line);
    return span.file == own_file_ ? line : fmt::format("{} of {}", line, file.name());
  }
  void say(std::size_t indent, std::string_view words) {
    text_ += fmt::format("{:{}}{}\n", "", indent, words);
  }

  // ---- names
  static std::string remembered(const ast::Use& node) {
    return fmt::format("  The program uses the module {}.\n", node.module.text);
  }
  static std::string remembered(const ast::Let& node) {
    return fmt::format("  {} stands for {}.\n", node.name.text, number(*node.value));
  }
  static std::string remembered(const ast::Remember& node) {
    return fmt::format("  {} is a number that the robot remembers{}, {} at first.\n",
                       node.name.text, node.kept ? ", even when it is switched off" : "",
                       number(*node.value));
  }
  static std::string remembered(const ast::State& node) {
    std::vector<std::string> labels;
    for (const ast::Name& label : node.labels)
      labels.emplace_back(label.text);
    return fmt::format("  {} is always one of {}; {} at first.\n", node.name.text, list(labels),
                       labels.empty() ? "nothing" : labels.front());
  }
  static std::string remembered(const ast::Timer& node) {
    return fmt::format("  {} is the time since its last RESTART; at first, since the start.\n",
                       node.name.text);
  }
  static std::string remembered(const ast::List& node) {
    const std::size_t count = node.items.size();
    const bool texts = std::ranges::any_of(node.items, [](const ast::Argument& item) {
      return std::holds_alternative<ast::Text>(item.value);
    });
    return fmt::format("  {} is a list of {} {}{}.\n", node.name.text, count,
                       texts ? "text" : "number", count == 1 ? "" : "s");
  }
  static std::string remembered(const ast::Feeling& node) {
    std::string text = fmt::format("  {} is a feeling from {} to {}, {} at first.", node.name.text,
                                   number(*node.from), number(*node.to), number(*node.start));
    if (node.fades_to && node.fades_over) {
      text += fmt::format(" Left alone, it fades to {}: after {} it is almost there.",
                          number(*node.fades_to), number(*node.fades_over));
    }
    return text + "\n";
  }
  static std::string remembered(const ast::Motion& node) {
    std::vector<std::string> columns;
    for (const ast::Name& column : node.columns)
      columns.emplace_back(column.text);
    return fmt::format("  {} is a motion of {}, {} long.\n", node.name.text, list(columns),
                       node.rows.empty() ? "nothing" : number(*node.rows.back().time));
  }
  template <typename Other>
  static std::string remembered(const Other&) {
    return {};
  }

  // ---- checks, limits, safety
  static std::string range(const ast::Band& band) {
    switch (band.kind) {
      case ast::BandKind::below:
        return "below " + number(*band.high);
      case ast::BandKind::above:
        return "above " + number(*band.low);
      case ast::BandKind::between:
        return fmt::format("from {} to {}", number(*band.low), number(*band.high));
      case ast::BandKind::otherwise:
        return "anything else";
    }
    return {};
  }

  void tell(const ast::Check& node, Span span) {
    say(0, fmt::format("\nCHECK {} ({}) puts {} into words:", node.name.text, place_of(span),
                       number(*node.operand)));
    for (const ast::Band& band : node.bands)
      say(kTextIndent, fmt::format("{}: {}", band.label.text, range(band)));
    if (node.bands.size() > 1) say(kTextIndent, "The first one from the top that fits counts.");
    if (node.margin) {
      say(kTextIndent,
          fmt::format("It leaves one only when the value is {} past its limit{}, so that it "
                      "does not flicker.",
                      number(*node.margin),
                      node.bands.size() > 1 ? ", or when an earlier one fits" : ""));
    }
    if (node.smooth) {
      say(kTextIndent, fmt::format("It uses the median of the readings of the last {}, so that a "
                                   "single wrong reading does not count.",
                                   number(*node.smooth)));
    }
  }

  void tell(const ast::Limit& node, Span span) {
    const std::string limit = number(*node.value);
    say(0, fmt::format("\nLIMIT ({}):", place_of(span)));
    if (folded(node.channel.text) == "speed") {
      say(kTextIndent, fmt::format("{} never moves faster than {}, whatever a rule asks for.",
                                   node.actuator.text, limit));
    } else {
      say(kTextIndent, fmt::format("While {0} {1} is more than {2}, or is unknown, {0} "
                                   "is stopped.",
                                   node.actuator.text, node.channel.text, limit));
    }
  }

  void tell(const ast::Safety& node, Span span) {
    say(0, fmt::format("\nSAFETY {} ({}), above all other rules:", node.name.text, place_of(span)));
    text_ += safety_text(node, defines_, kTextIndent);
  }

  // ---- behaviours
  int priority_of(const ast::Behavior& node) const {
    if (node.priority || robot_ == nullptr) return to_number(node.priority);
    for (const BehaviorConfig& config : robot_->behaviors) {
      if (folded(config.name.text) == folded(node.name.text)) return config.priority.value_or(0);
    }
    return 0;
  }

  ActuatorNames used_by(const ast::Block& body) {
    Used used;
    add_used(body, trees_, defines_, robot_, used);
    used_defines_.merge(used.defines);
    return used.actuators;
  }

  void add(ActuatorNames& names, const ast::Rule& rule) {
    const auto block = [&](const ast::Block& body) { names.merge(used_by(body)); };
    if (const auto* when = std::get_if<ast::WhenRule>(&rule.node)) {
      block(when->then_block);
      if (when->else_block) block(*when->else_block);
    } else {
      std::visit(
          [&](const auto& node) {
            if constexpr (requires { node.body; }) block(node.body);
          },
          rule.node);
    }
  }

  void find_parties() {
    int unnumbered = 0;
    for_each_item([&](const ast::Item& item) {
      if (const auto* node = std::get_if<ast::Behavior>(&item.node)) {
        Party party{std::string(node->name.text), priority_of(*node), {}};
        for (const ast::Rule& rule : node->rules)
          add(party.actuators, rule);
        parties_.push_back(std::move(party));
      } else if (const auto* rule = std::get_if<ast::Rule>(&item.node)) {
        const bool numbered = rule->modifiers.priority.has_value();
        Party party{"the rule at " + place_of(rule->span),
                    numbered ? to_number(rule->modifiers.priority) : unnumbered--,
                    {}};
        add(party.actuators, *rule);
        parties_.push_back(std::move(party));
      } else if (const auto* const safety = std::get_if<ast::Safety>(&item.node)) {
        (void)used_by(safety->body);
      } else if (const auto* const define = std::get_if<ast::Define>(&item.node);
                 define != nullptr && is_own(item)) {
        (void)used_by(define->body);
      }
    });
  }

  void tell_meetings(bool several_rules) {
    const Party& party = parties_.at(next_party_++);
    if (!party.actuators.empty()) {
      say(kTextIndent,
          fmt::format("It uses {}.", list({party.actuators.begin(), party.actuators.end()})));
    }
    for (const std::string& line : meetings(party, parties_))
      say(kTextIndent, line);
    if (several_rules && !party.actuators.empty()) {
      say(kTextIndent,
          "Among its own rules, the later one interrupts the earlier one if both need the "
          "same actuator.");
    }
  }

  void tell(const ast::Behavior& node, Span span) {
    const int priority = priority_of(node);
    say(0, fmt::format("\nBEHAVIOR {} ({}){}:", node.name.text, place_of(span),
                       priority > 0 ? fmt::format(", priority {}", priority) : ""));
    tell_meetings(node.rules.size() > 1);
    for (const ast::Remember& variable : node.variables)
      text_ += remembered(variable);
    for (const ast::Rule& rule : node.rules) {
      text_ += '\n';
      text_ += rule_text(rule, place_of(rule.span), defines_, kTextIndent);
    }
  }

  void tell(const ast::Rule& node, Span span) {
    const int priority = to_number(node.modifiers.priority);
    say(0, fmt::format("\nA rule outside any BEHAVIOR, {}:",
                       priority > 0 ? fmt::format("priority {}", priority)
                                    : std::string("less important than everything with a priority "
                                                  "and than earlier rules without one")));
    tell_meetings(false);
    text_ += rule_text(node, place_of(span), defines_, kTextIndent);
  }

  void tell(const ast::Define& node, Span span) {
    std::vector<std::string> parameters;
    for (const ast::Name& parameter : node.parameters)
      parameters.emplace_back(parameter.text);
    say(0, fmt::format("\nDEFINE {}{} ({}) means:", node.name.text,
                       parameters.empty() ? "" : " with " + list(parameters), place_of(span)));
    text_ += statements(node.body, defines_, kTextIndent);
  }

  Trees trees_;
  FileId own_file_ = 0;
  const SourceMap& sources_;
  const Robot* robot_;
  Defines defines_;
  std::set<const ast::Define*> used_defines_;
  std::vector<Party> parties_;  // in the order of the file
  std::size_t next_party_ = 0;
  std::string text_;
};

}  // namespace

std::string program_text(Trees trees, const SourceMap& sources, const Robot* robot) {
  return Teller(trees, sources, robot).tell();
}

}  // namespace robosync::compiler::explain
