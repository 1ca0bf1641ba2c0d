// The resolved program: sema creates it, the optimiser changes it, codegen reads it. Values are thousandths of the canonical
// unit. Sensors and actuators are indexes in the Robot's lists, variables are indexes in Program::variables. DEFINEs are
// expanded: their arguments are constants or locals.
//
// Each kind of statement defines three properties, which all passes use (ir/walk.hpp):
//   kParts   its expressions and blocks, in the program's order
//   kPauses  whether it pauses, so that the response continues in a later step
//   kCells   an upper bound on the frame cells it keeps: locals, counters, deadlines
// Only Set writes variables; only Command and Halt name actuators.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <tuple>
#include <variant>
#include <vector>

#include "compiler/ir/expression.hpp"
#include "compiler/source/source_file.hpp"
#include "vm/image.hpp"

namespace robosync::compiler {
struct Unit;  // units/units.hpp
}

namespace robosync::compiler::ir {

// ---- variables

struct Variable {
  std::string name;
  vm::VariableKind kind{};
  vm::Dimension dimension{};
  const Unit* unit = nullptr;       // as written in the program; null: it has none
  std::vector<std::string> labels;  // of state and band
  vm::Value initial = 0;            // kUnknown for band
  vm::Value min = vm::kValueMin, max = vm::kValueMax;
  vm::Value fades_to = 0;
  std::uint32_t fade = 0;  // vm::Variable::fade
};

struct Check {
  std::size_t variable = 0;  // of kind band; its labels are those of the bands, in their order
  Expression input;          // a channel or a variable
  std::vector<vm::Band> bands;
  std::uint16_t window = 1;  // samples
  std::uint16_t sample_ms = 0;
};

// A MOTION that the program performs: the positions of its actuators over time.
struct Track {
  std::size_t actuator = 0;
  std::vector<vm::Key> keys;
};
struct Motion {
  std::string name;
  vm::Value length = 0;  // time of its last row
  std::vector<Track> tracks;
};

// ---- statements

struct Argument {
  vm::Param param{};
  Expression value;
  static constexpr std::tuple kParts{&Argument::value};
  bool operator==(const Argument&) const = default;
};

// A word or text that sets one parameter. It belongs to the command's first actuator.
struct Word {
  std::string name;
  vm::Param param{};
  vm::Value value = 0;
  bool operator==(const Word&) const = default;
};

struct Verb {
  std::string name;
  vm::Action action{};
  std::uint8_t takes = 0;
  bool operator==(const Verb&) const = default;
};

// A command for one or more actuators. STOP in a response is a command with the verb STOP; STOP ALL is one command for each
// actuator. PERFORM is one command for all actuators of its MOTION.
struct Command {
  std::optional<std::size_t> group;    // index in Robot::groups: the target is the group …
  std::vector<std::size_t> actuators;  // … and these are its members; else exactly one
  Verb verb;
  std::optional<Word> word;
  std::vector<Argument> arguments;
  // For PERFORM: the index in Program::motions. `actuators` are all that the MOTION moves.
  std::optional<std::size_t> motion{};
  static constexpr bool kPauses = false;
  static constexpr std::size_t kCells = 0;
  static constexpr std::tuple kParts{&Command::arguments};
};

struct Statement;
using Block = std::vector<Statement>;

struct Local {  // a value that is computed here: an argument of a DEFINE
  std::size_t number = 0;
  Expression value;
  bool has_other_writers = false;  // then its value depends on the path to here
  static constexpr bool kPauses = false;
  static constexpr std::size_t kCells = 1;
  static constexpr std::tuple kParts{&Local::value};
};
struct Set {
  std::size_t variable = 0;
  Expression value;
  bool relative = false;  // RAISE, LOWER, SIGNAL: `value` is added
  // Proved by the optimiser: the variable was already written in this run, so it can be computed in place; and whether the result
  // may be outside the variable's range.
  bool in_place = false;
  bool may_be_below = true, may_be_above = true;
  Fact before{};  // the fact of the variable before the statement
  static constexpr bool kPauses = false;
  static constexpr std::size_t kCells = 0;
  static constexpr std::tuple kParts{&Set::value};
};
struct Wait {
  Expression duration;
  static constexpr bool kPauses = true;
  static constexpr std::size_t kCells = 0;
  static constexpr std::tuple kParts{&Wait::duration};
};
struct WaitUntil {
  Expression condition;
  std::optional<Expression> within;
  static constexpr bool kPauses = true;
  static constexpr std::size_t kCells = 1;
  static constexpr std::tuple kParts{&WaitUntil::condition, &WaitUntil::within};
};
// FOLLOW: the body runs in each step that may change what it reads, starting with the next step, until the time is over; without
// a time, as long as the response runs. Values that last from one run of the body to the next are locals in front of the
// statement.
struct Follow {
  std::optional<Expression> lasts;
  Block body;  // it does not pause
  static constexpr bool kPauses = true;
  static constexpr std::size_t kCells = 1;
  static constexpr std::tuple kParts{&Follow::lasts, &Follow::body};
};
struct Then {
  static constexpr bool kPauses = true;
  static constexpr std::size_t kCells = 0;
  static constexpr std::tuple<> kParts{};
};
struct If {
  Expression condition;
  Block then_block, else_block;
  static constexpr bool kPauses = false;
  static constexpr std::size_t kCells = 0;
  static constexpr std::tuple kParts{&If::condition, &If::then_block, &If::else_block};
};
enum class RepeatKind : std::uint8_t { times, while_, forever };
struct Repeat;
// How often the loop runs, if that is constant: a whole number in thousandths, 0 for never.
[[nodiscard]] std::optional<vm::Value> constant_count(const Repeat& repeat);
struct Repeat {
  RepeatKind kind{};
  Expression control;  // times: the number; while_: the condition
  Block body;
  // Variables that the body is certain to write. The optimiser has each written with its own value once before the loop, so that
  // the body can compute it in place.
  std::vector<std::size_t> assigned{}, shifted{};
  static constexpr bool kPauses = false;
  static constexpr std::size_t kCells = 1;
  static constexpr std::tuple kParts{&Repeat::control, &Repeat::body};
};
struct Option {
  vm::Value weight = 0;  // share of the sum of all weights; positive
  Block body;
  static constexpr std::tuple kParts{&Option::body};
};
struct Pick {
  std::vector<Option> options;
  static constexpr bool kPauses = false;
  static constexpr std::size_t kCells = 1;
  static constexpr std::tuple kParts{&Pick::options};
};
struct Log {  // LOG; ALERT if `alert`
  bool alert = false;
  std::string text;                // with a {} placeholder for each value
  std::vector<Expression> values;  // at most as many as there are vm::Params
  static constexpr bool kPauses = false;
  static constexpr std::size_t kCells = 0;
  static constexpr std::tuple kParts{&Log::values};
};
struct Halt {  // STOP in a SAFETY rule
  bool all = false;
  std::optional<std::size_t> group;
  std::vector<std::size_t> actuators;
  static constexpr bool kPauses = false;
  static constexpr std::size_t kCells = 0;
  static constexpr std::tuple<> kParts{};
};

struct Statement {
  std::variant<Command, Local, Set, Wait, WaitUntil, Follow, Then, If, Repeat, Pick, Log, Halt>
      node;
  std::uint16_t line = 0;
  Span span;
};

// True if the statement itself pauses; for a block, if any statement in it pauses, at any depth.
[[nodiscard]] bool is_pause(const Statement& statement);
[[nodiscard]] bool pauses(const Block& block);

// ---- rules

struct Rule {
  vm::RuleKind kind = vm::RuleKind::when;  // when … start; safety
  Expression condition;                    // every: the period; start: none
  Block then_response;
  Block else_response;               // only for when_else
  std::optional<Expression> resume;  // for safety; nullopt: only a person can resume
  vm::Value cooldown = 0;            // thousandths of a second; 0: none
  vm::Value waiting = 0;
  bool restarting = false;
  std::uint16_t line = 0;
  Span span{};  // its first word
};

struct Behavior {
  std::int16_t priority = 0;
  std::string name;  // empty: a rule outside a BEHAVIOR
  std::vector<Rule> rules;
};

// A word that the program compares a channel with, if the channel learns its words.
struct LearnedWord {
  ChannelRef channel;
  std::string text;
};

struct Program {
  // In the order of their labels. They are not yet added to the robot's channels.
  std::vector<LearnedWord> words;
  std::vector<Variable> variables;
  std::vector<Check> checks;
  std::vector<Motion> motions;
  std::vector<Rule> safety;
  std::vector<Behavior> behaviors;  // priorities descending, distinct
  // LIMIT … SPEED, by index in Robot::actuators. The stricter of this and the robot's own limit applies.
  std::vector<std::pair<std::size_t, vm::Value>> speed_limits;
  bool optimized = false;  // facts are filled in, and codegen may use them
  bool shares = false;     // … and evaluate equal parts of a condition once: the frames have room
};

}  // namespace robosync::compiler::ir
