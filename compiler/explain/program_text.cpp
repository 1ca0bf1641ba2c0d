// Accepts any tree of the parser. Each part keeps the program's own order.
#include "compiler/explain/program_text.hpp"

#include <algorithm>
#include <charconv>

#include <fmt/format.h>

#include "compiler/explain/actuators.hpp"
#include "compiler/explain/conditions.hpp"
#include "compiler/explain/rules.hpp"

namespace robosync::compiler::explain {
namespace {

constexpr std::size_t kIndent = 2;

// Readers who know how rules are evaluated make fewer mistakes.
constexpr std::string_view kHowItWorks =
    "How the robot works through its rules:\n"
    "  - \"As soon as\" happens once, at the moment something becomes true, or at start if it is\n"
    "    true already. It must stop being true before it can happen again.\n"
    "  - \"While\" goes on for as long as something is true, and stops when it is not.\n"
    "  - An actuator does what one rule wants at a time. The rule with the higher priority gets\n"
    "    it; what the other was doing is given up as a whole and not taken up again, except by\n"
    "    a \"while\" that is still true.\n"
    "  - A sensor that says nothing is unknown: rules do nothing then, safety rules stop.\n";

int to_number(const std::optional<ast::Name>& digits) {
  int number = 0;
  if (digits) {
    std::from_chars(digits->text.data(), digits->text.data() + digits->text.size(), number);
  }
  return number;
}

class Teller {
public:
  Teller(const ast::Tree& program, const SourceMap& sources, const Robot* robot)
      : program_(program), sources_(sources), robot_(robot), defines_(defines_of(program)) {}

  std::string tell() {
    find_parties();
    std::string memory;
    for (const ast::Item& item : program_.items)
      memory += std::visit([&](const auto& node) { return remembered(node); }, item.node);
    if (!memory.empty()) text_ += "\nWhat has a name:\n" + memory;
    tell_each<ast::Check>();
    tell_each<ast::Limit>();
    tell_each<ast::Safety>();
    for (const ast::Item& item : program_.items) {
      if (const auto* node = std::get_if<ast::Behavior>(&item.node)) tell(*node, item.span);
      if (const auto* node = std::get_if<ast::Rule>(&item.node)) tell(*node, item.span);
    }
    tell_each<ast::Define>();
    return std::string(kHowItWorks) + text_;
  }

private:
  template <typename Node>
  void tell_each() {
    for (const ast::Item& item : program_.items) {
      if (const auto* node = std::get_if<Node>(&item.node)) tell(*node, item.span);
    }
  }

  std::size_t line_of(Span span) const {
    return sources_.file(span.file).position(span.begin).line;
  }
  void say(std::size_t indent, std::string_view words) {
    text_ += fmt::format("{:{}}{}\n", "", indent, words);
  }

  // ---- names
  static std::string remembered(const ast::Use& node) {
    return fmt::format("  What the module {} offers can be used here.\n", node.module.text);
  }
  static std::string remembered(const ast::Let& node) {
    return fmt::format("  {} stands for {}.\n", node.name.text, number(*node.value));
  }
  static std::string remembered(const ast::Remember& node) {
    return fmt::format("  {} is a number that the robot remembers{}, {} at first.\n",
                       node.name.text, node.kept ? ", also when it is switched off" : "",
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
      text += fmt::format(" Left alone it fades to {}: after {} it is nearly there.",
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
    say(0, fmt::format("\nCHECK {} (line {}) puts {} into words:", node.name.text, line_of(span),
                       number(*node.operand)));
    for (const ast::Band& band : node.bands)
      say(kIndent, fmt::format("{}: {}", band.label.text, range(band)));
    if (node.bands.size() > 1) say(kIndent, "The first that fits from the top is the one.");
    if (node.margin) {
      say(kIndent, fmt::format("One is left only when the value is {} past its limit, so that it "
                               "does not flicker.",
                               number(*node.margin)));
    }
    if (node.smooth) {
      say(kIndent, fmt::format("The middle one of the readings of the last {} counts, so that a "
                               "single wrong reading does not.",
                               number(*node.smooth)));
    }
  }

  void tell(const ast::Limit& node, Span span) {
    const std::string limit = number(*node.value);
    say(0, fmt::format("\nLIMIT (line {}):", line_of(span)));
    if (folded(node.channel.text) == "speed") {
      say(kIndent, fmt::format("{} never moves faster than {}, whatever a rule asks for.",
                               node.actuator.text, limit));
    } else {
      say(kIndent,
          fmt::format("While {0} {1} is more than {2}, and also while it is not known, {0} "
                      "is stopped.",
                      node.actuator.text, node.channel.text, limit));
    }
  }

  void tell(const ast::Safety& node, Span span) {
    say(0, fmt::format("\nSAFETY {} (line {}). Nothing is more important:", node.name.text,
                       line_of(span)));
    text_ += safety_text(node, defines_, kIndent);
  }

  // ---- behaviours
  int priority_of(const ast::Behavior& node) const {
    if (node.priority || robot_ == nullptr) return to_number(node.priority);
    for (const BehaviorConfig& config : robot_->behaviors) {
      if (folded(config.name.text) == folded(node.name.text)) return config.priority.value_or(0);
    }
    return 0;
  }

  void add(ActuatorNames& names, const ast::Rule& rule) const {
    const auto block = [&](const ast::Block& body) {
      names.merge(actuators_of(body, program_, defines_, robot_));
    };
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
    for (const ast::Item& item : program_.items) {
      if (const auto* node = std::get_if<ast::Behavior>(&item.node)) {
        Party party{std::string(node->name.text), priority_of(*node), {}};
        for (const ast::Rule& rule : node->rules)
          add(party.actuators, rule);
        parties_.push_back(std::move(party));
      } else if (const auto* rule = std::get_if<ast::Rule>(&item.node)) {
        const bool numbered = rule->modifiers.priority.has_value();
        Party party{fmt::format("the rule at line {}", line_of(rule->span)),
                    numbered ? to_number(rule->modifiers.priority) : unnumbered--,
                    {}};
        add(party.actuators, *rule);
        parties_.push_back(std::move(party));
      }
    }
  }

  void tell_meetings(bool several_rules) {
    const Party& party = parties_.at(next_party_++);
    if (!party.actuators.empty()) {
      say(kIndent,
          fmt::format("It uses {}.", list({party.actuators.begin(), party.actuators.end()})));
    }
    for (const std::string& line : meetings(party, parties_))
      say(kIndent, line);
    if (several_rules && !party.actuators.empty()) {
      say(kIndent,
          "Of its own rules, the later one interrupts the earlier one if both need the "
          "same actuator.");
    }
  }

  void tell(const ast::Behavior& node, Span span) {
    const int priority = priority_of(node);
    say(0, fmt::format("\nBEHAVIOR {} (line {}){}:", node.name.text, line_of(span),
                       priority > 0 ? fmt::format(", priority {}", priority) : ""));
    tell_meetings(node.rules.size() > 1);
    for (const ast::Remember& variable : node.variables)
      text_ += remembered(variable);
    for (const ast::Rule& rule : node.rules) {
      text_ += '\n';
      text_ += rule_text(rule, line_of(rule.span), defines_, kIndent);
    }
  }

  void tell(const ast::Rule& node, Span span) {
    const int priority = to_number(node.modifiers.priority);
    say(0, fmt::format("\nA rule of its own, {}:",
                       priority > 0
                           ? fmt::format("priority {}", priority)
                           : std::string("less important than every behaviour with a priority "
                                         "and than such rules before it")));
    tell_meetings(false);
    text_ += rule_text(node, line_of(span), defines_, kIndent);
  }

  void tell(const ast::Define& node, Span span) {
    std::vector<std::string> parameters;
    for (const ast::Name& parameter : node.parameters)
      parameters.emplace_back(parameter.text);
    say(0, fmt::format("\nDEFINE {}{} (line {}) means:", node.name.text,
                       parameters.empty() ? "" : " with " + list(parameters), line_of(span)));
    text_ += statements(node.body, defines_, kIndent);
  }

  const ast::Tree& program_;
  const SourceMap& sources_;
  const Robot* robot_;
  Defines defines_;
  std::vector<Party> parties_;  // in the order of the file
  std::size_t next_party_ = 0;
  std::string text_;
};

}  // namespace

std::string program_text(const ast::Tree& program, const SourceMap& sources, const Robot* robot) {
  return Teller(program, sources, robot).tell();
}

}  // namespace robosync::compiler::explain
