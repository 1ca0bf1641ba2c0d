// The names of a program, its modules and its robot, and their meanings.
//
// LET, REMEMBER, STATE, FEELING, CHECK, DEFINE, BEHAVIOR, SAFETY and signals share one name space,
// which must not contain a sensor's name. A REMEMBER in a BEHAVIOR is visible only there.
#pragma once

#include <forward_list>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "compiler/config/robot.hpp"
#include "compiler/ir/program.hpp"
#include "compiler/syntax/ast.hpp"

namespace robosync::compiler {

struct ConstantName {
  const ast::Let* let = nullptr;
  bool in_module = false;
  bool used = false;
};

struct DefineName {
  const ast::Define* define = nullptr;
  Span span;
  bool in_module = false;
  bool used = false;      // something runs it
  bool expanded = false;  // it has been translated
};

struct MotionName {
  const ast::Motion* motion = nullptr;
  bool in_module = false;
  bool seen = false;                   // it has been translated (Motions) …
  std::optional<std::size_t> place{};  // … and has this index
};

struct VariableName {
  ast::Name name;
  std::size_t index = 0;  // in ir::Program::variables
  // std::monostate: a signal.
  std::variant<std::monostate, const ast::Remember*, const ast::State*, const ast::Timer*,
               const ast::Feeling*, const ast::Check*>
      declared;
  vm::VariableKind kind = vm::VariableKind::signal;
  std::vector<std::string> labels;  // of state and band
  bool in_module = false;
  // Its declaration has a mistake, which has been reported: no more messages about it.
  bool taken = false;
  bool heard = false;  // a condition asks for this signal
  // Valid once it has been declared (Variables).
  bool ready = false;
  const Unit* unit = nullptr;
  Span unit_span{};
  std::int64_t low = vm::kValueMin;  // its range
  std::int64_t high = vm::kValueMax;
  std::optional<vm::Value> fixed{};  // its value, if it is a REMEMBER that nothing sets
};

// "there is no variable `x`", the same wherever it is used, so that one message can stand for all.
inline std::string no_variable(const ast::Name& name) {
  return "there is no variable " + name.shown();
}

struct ListName {
  const ast::List* list = nullptr;
  std::vector<std::string> texts;
  bool in_module = false;
  bool numbers = false;  // holds numbers, which Expressions evaluates, instead of texts
  // Variables that hold the index of the last text, from 1; 0 before the first. Present only if used.
  std::optional<std::size_t> any{}, next{};

  [[nodiscard]] std::size_t count() const { return list->items.size(); }
};

// The meaning of a name in an actuator's place.
struct Target {
  std::optional<std::size_t> group;
  std::vector<std::size_t> actuators;  // empty only if robot.json has a mistake in the group
  std::string name;                    // as in robot.json
};

// The program first, then the modules that it uses.
using Trees = std::vector<const ast::Tree*>;

class Names {
public:
  // Collects the names and reports those given twice. The trees and the robot must outlive this.
  Names(const Trees& trees, const Robot& robot, Diagnostics& diagnostics);

  // The channel of `touch LEVEL`, `touchLevel`, or of a sensor that has only one. Reports
  // mistakes.
  [[nodiscard]] std::optional<ChannelRef> find_channel(const ast::Operand& operand);
  [[nodiscard]] ConstantName* find_constant(std::string_view name);  // nullptr: none
  [[nodiscard]] DefineName* find_define(std::string_view name);
  [[nodiscard]] const ListName* find_list(std::string_view name) const;
  [[nodiscard]] std::vector<std::string> list_names_given() const;
  [[nodiscard]] MotionName* find_motion(std::string_view name);
  [[nodiscard]] VariableName* find_variable(std::string_view name);
  [[nodiscard]] std::optional<Target> find_target(std::string_view name) const;
  [[nodiscard]] std::optional<std::size_t> find_sensor(std::string_view name) const;
  [[nodiscard]] bool is_verb(std::string_view name) const;  // of any actuator
  [[nodiscard]] bool is_word(std::string_view name) const;  // of any actuator: SLOWLY
  // The indices of the actuators that know a verb, in ascending order.
  [[nodiscard]] const std::vector<std::size_t>& able_to(std::string_view verb) const;
  // The index of a label in the labels of a channel or a variable, which must outlive this.
  [[nodiscard]] std::optional<std::size_t> find_label(const std::vector<std::string>& labels,
                                                      std::string_view label);
  // Adds a label to a channel that learns its words and returns its index. `label` must outlive this, too.
  [[nodiscard]] std::size_t learn_label(ChannelRef ref, std::string_view label);
  [[nodiscard]] const std::vector<ir::LearnedWord>& learned() const { return learned_; }
  // The kind of a name, for a message: "a LET", "a CHECK"; empty for an unknown name.
  [[nodiscard]] std::string kind_of(std::string_view name);

  // Sets the BEHAVIOR whose private variables are visible; nullptr: none. Returns the previous one.
  const ast::Behavior* set_scope(const ast::Behavior* behavior);

  [[nodiscard]] const SensorConfig& sensor(ChannelRef ref) const {
    return robot_.sensors[ref.sensor];
  }
  [[nodiscard]] const ActuatorConfig& actuator(std::size_t place) const {
    return robot_.actuators[place];
  }
  [[nodiscard]] const ChannelConfig& channel(ChannelRef ref) const {
    return sensor(ref).channels[ref.channel];
  }
  [[nodiscard]] std::string channel_name(ChannelRef ref) const;  // "touch LEVEL"

  [[nodiscard]] std::vector<std::string> target_names() const;
  // Suggests what the robot calls its only sensor or actuator of this device; false if there is none.
  bool help_with_sensor(Diagnostic& diagnostic, const ast::Name& device) const;
  bool help_with_actuator(Diagnostic& diagnostic, const ast::Name& device) const;
  // Makes the fix uncertain if it writes a group for a word that may mean one of its members: `arm` for `arms`.
  void doubt_group(Diagnostic& diagnostic, std::string_view word) const;
  [[nodiscard]] std::vector<std::string> verb_names() const;
  [[nodiscard]] std::vector<std::string> define_names() const;
  [[nodiscard]] std::vector<std::string> variable_names() const;  // those visible here
  [[nodiscard]] std::vector<std::string> motion_names() const;
  [[nodiscard]] const std::map<std::string, MotionName>& motions() const { return motions_; }
  [[nodiscard]] const std::map<std::string, DefineName>& defines() const { return defines_; }
  [[nodiscard]] const std::map<std::string, ConstantName>& constants() const { return constants_; }
  [[nodiscard]] const std::map<std::string, ListName>& lists() const { return lists_; }
  // In the order of ir::Program::variables.
  [[nodiscard]] std::vector<VariableName>& variables() { return variables_; }
  // True if a SET, RAISE or LOWER names it, in whatever scope.
  [[nodiscard]] bool is_set(const VariableName& variable) const;

private:
  using Places = std::map<std::string, std::size_t>;  // indices of variables, by folded name

  // Collecting.
  void collect(const ast::Tree& tree);
  void add(const ast::Let& let);
  void add(const ast::Define& define);
  void add(const ast::Motion& motion);
  void add(const ast::Behavior& behavior);
  void add(const ast::Remember& variable);
  void add(const ast::State& state);
  void add(const ast::Timer& timer);
  void add(const ast::List& list);
  void add(const ast::Feeling& feeling);
  void add(const ast::Check& check);
  bool tears_channel(const ast::Check& check) const;
  void add(const ast::Safety& safety) { claim(safety.name); }
  template <typename Other>
  void add(const Other&) {}  // has no name
  void collect_signals(const ast::Tree& tree);
  void add_signals(const ast::Block& block);
  void add_set(const ast::Stmt& stmt);
  void add_signal(const ast::Name& name);
  void add_turns(const ast::Stmt& stmt);
  void add_turn(const ast::Name& how, const ast::Name& list);
  void check_parameters(const ast::Define& define);
  bool claim(const ast::Name& name);
  bool claim_operand(const ast::Name& name);
  void report_twice(const ast::Name& name, Span first);
  void add_variable(VariableName variable, Places& places);

  void index_robot();
  [[nodiscard]] bool names_a_channel(std::string_view name) const;
  std::optional<ChannelRef> channel_of_sensor(std::size_t sensor, const ast::Operand& operand);
  bool report_missing(const ast::Operand& operand);
  void report_unknown(const ast::Operand& operand);
  bool help_with_word(Diagnostic& d, const ast::Name& name) const;
  bool help_with_parts(Diagnostic& d, const ast::Operand& operand) const;
  bool report_known(const ast::Name& name);

  const Robot& robot_;
  Diagnostics& diagnostics_;
  bool in_module_ = false;                         // while collecting
  std::map<std::string, Span> claimed_;            // by folded name
  std::map<std::string, ConstantName> constants_;  // by folded name
  std::map<std::string, DefineName> defines_;
  std::map<std::string, ListName> lists_;
  std::map<std::string, MotionName> motions_;
  std::vector<VariableName> variables_;
  std::set<std::string> set_;                  // what a SET, RAISE or LOWER names, folded
  std::forward_list<std::string> made_names_;  // of variables without a name in the source
  Places globals_;
  std::map<const ast::Behavior*, Places> private_;
  const ast::Behavior* scope_ = nullptr;

  // The robot's names.
  NameIndex sensors_, actuators_, groups_;
  std::vector<NameIndex> own_channels_;   // by sensor
  std::vector<std::string> joined_;       // "touchLEVEL"
  std::vector<ChannelRef> channel_refs_;  // the channel of each joined name
  NameIndex channels_;                    // indices of the joined names
  NameIndex verbs_, words_;
  std::vector<std::vector<std::size_t>> able_;  // actuators, by index of the verb
  std::map<const std::vector<std::string>*, NameIndex> labels_;
  std::vector<ir::LearnedWord> learned_;
};

}  // namespace robosync::compiler
