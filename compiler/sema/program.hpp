// The program with everything resolved: what sema hands to codegen. Values are thousandths of the
// canonical unit; sensors and actuators are places in the Robot's lists, variables are places in
// Program::variables. DEFINEs are expanded: what they are given is constant, or a local.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "compiler/optimize/fact.hpp"
#include "compiler/source/source_file.hpp"
#include "vm/image.hpp"

namespace robosync::compiler {

struct ChannelRef {
  std::size_t sensor = 0;
  std::size_t channel = 0;  // of the sensor
  bool operator==(const ChannelRef&) const = default;
  bool operator<(const ChannelRef& other) const {
    return sensor != other.sensor ? sensor < other.sensor : channel < other.channel;
  }
};

enum class Operation : std::uint8_t {
  constant,
  input,     // a channel
  variable,  // Expression::index: its place in Program::variables
  local,     // Expression::index: its number in the response (ProgramLocal)
  negate,
  add,
  subtract,
  multiply,
  divide,
  modulo,
  random,  // from the first operand to the second
  less,
  less_equal,
  greater,
  greater_equal,
  equal,
  not_equal,
  logical_not,
  logical_and,
  logical_or,
  // Time words. `constant` is the duration, of `changed` the least difference. They remember the
  // past: each stands for one timer, which is evaluated in every step.
  held,      // operand FOR
  counted,   // operand `index` TIMES WITHIN
  sequence,  // first operand THEN second operand WITHIN
  latch,     // first operand enters, second operand stays: MARGIN
  rose,      // operand becomes true
  changed    // the number CHANGES [BY]
};

// A number or a truth value. Operands: none, one or two, by its operation.
struct Expression {
  Operation operation = Operation::constant;
  vm::Value constant = 0;
  std::size_t index = 0;
  ChannelRef channel;
  std::vector<Expression> operands;
  Fact fact{};  // what the optimiser has proved of it, in this place
  // The same computation, whatever is known of it.
  bool operator==(const Expression& other) const;
};

// Does it, or a part of it, remember the past?
[[nodiscard]] bool has_time_word(const Expression& expression);

// ---- what is remembered

struct ProgramVariable {
  std::string name;
  vm::VariableKind kind{};
  vm::Dimension dimension{};
  std::vector<std::string> labels;  // of state and band
  vm::Value initial = 0;            // kUnknown for band
  vm::Value min = vm::kValueMin, max = vm::kValueMax;
  vm::Value fades_to = 0;
  std::uint32_t fade = 0;  // vm::Variable::fade
};

struct ProgramCheck {
  std::size_t variable = 0;  // of kind band; its labels are those of the bands, in their order
  Expression input;          // a channel or a variable
  std::vector<vm::Band> bands;
  std::uint16_t window = 1;  // samples
  std::uint16_t sample_ms = 0;
};

// ---- what responses do

struct ProgramArgument {
  vm::Param param{};
  Expression value;
  bool operator==(const ProgramArgument&) const = default;
};

// A word or text of the first actuator it is for, which sets one parameter.
struct ProgramWord {
  std::string name;
  vm::Param param{};
  vm::Value value = 0;
  bool operator==(const ProgramWord&) const = default;
};

struct ProgramVerb {
  std::string name;
  vm::Action action{};
  std::uint8_t takes = 0;
  bool operator==(const ProgramVerb&) const = default;
};

// One or several actuators. STOP in a response is a command with the verb STOP; STOP ALL is one for
// each actuator.
struct ProgramCommand {
  std::optional<std::size_t> group;    // place in Robot::groups: the target is the group …
  std::vector<std::size_t> actuators;  // … and these are its members; else exactly one
  ProgramVerb verb;
  std::optional<ProgramWord> word;
  std::vector<ProgramArgument> arguments;
};

struct ProgramStatement;
using ProgramBlock = std::vector<ProgramStatement>;

struct ProgramLocal {      // a value that is worked out once: what a DEFINE is given
  std::size_t number = 0;  // distinct in the response
  Expression value;
};
struct ProgramSet {
  std::size_t variable = 0;
  Expression value;
  bool relative = false;  // RAISE, LOWER, SIGNAL: `value` is added
  // What the optimiser has proved: the variable was written in this run already, so that it can be
  // computed where it stands; and the result may be outside of the variable's range.
  bool in_place = false;
  bool may_be_below = true, may_be_above = true;
  Fact before{};  // what the variable is before
};
struct ProgramWait {
  Expression duration;
};
struct ProgramWaitUntil {
  Expression condition;
  std::optional<Expression> within;
};
struct ProgramThen {};
struct ProgramIf {
  Expression condition;
  ProgramBlock then_block, else_block;
};
enum class RepeatKind : std::uint8_t { times, while_, forever };
struct ProgramRepeat;
// How often it runs, when that is constant: a whole number in thousandths, 0 for never.
[[nodiscard]] std::optional<vm::Value> constant_count(const ProgramRepeat& repeat);
struct ProgramRepeat {
  RepeatKind kind{};
  Expression control;  // times: the number; while_: the condition
  ProgramBlock body;
  // Variables that the body certainly writes: the optimiser has them written once before the loop
  // (to what they are), so that the body computes them in place.
  std::vector<std::size_t> assigned{}, shifted{};
};
struct ProgramOption {
  vm::Value weight = 0;  // share of the sum of all weights; positive
  ProgramBlock body;
};
struct ProgramPick {
  std::vector<ProgramOption> options;
};
struct ProgramLog {
  std::string text;                // with a {} for each value
  std::vector<Expression> values;  // at most as many as there are vm::Params
};
struct ProgramAlert {
  std::string text;
};
struct ProgramHalt {  // STOP in a SAFETY rule
  bool all = false;
  std::optional<std::size_t> group;
  std::vector<std::size_t> actuators;
};

struct ProgramStatement {
  std::variant<ProgramCommand, ProgramLocal, ProgramSet, ProgramWait, ProgramWaitUntil, ProgramThen,
               ProgramIf, ProgramRepeat, ProgramPick, ProgramLog, ProgramAlert, ProgramHalt>
      node;
  std::uint16_t line = 0;
  Span span;
};

// ---- when they do it

struct ProgramRule {
  vm::RuleKind kind = vm::RuleKind::when;  // when … start; safety
  Expression condition;                    // every: the period; start: none
  ProgramBlock then_response;
  ProgramBlock else_response;        // only of when_else
  std::optional<Expression> resume;  // of safety; nothing: only a person resumes
  vm::Value cooldown = 0;            // thousandths of a second; 0: none
  vm::Value waiting = 0;
  bool restarting = false;
  std::uint16_t line = 0;
  Span span{};  // its first word
};

struct ProgramBehavior {
  std::int16_t priority = 0;
  std::string name;  // empty: a rule outside a BEHAVIOR
  std::vector<ProgramRule> rules;
};

struct Program {
  std::vector<ProgramVariable> variables;
  std::vector<ProgramCheck> checks;
  std::vector<ProgramRule> safety;
  std::vector<ProgramBehavior> behaviors;  // priorities descending, distinct
  // LIMIT … SPEED, by place in Robot::actuators; the stricter of this and the robot's own holds.
  std::vector<std::pair<std::size_t, vm::Value>> speed_limits;
  bool optimized = false;  // facts are filled in, and codegen may make use of them
};

}  // namespace robosync::compiler
