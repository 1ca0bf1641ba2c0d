// The program with everything resolved: what sema makes, the optimiser changes and codegen reads.
// Values are thousandths of the canonical unit; sensors and actuators are places in the Robot's
// lists, variables are places in Program::variables. DEFINEs are expanded: what they are given is
// constant, or a local.
//
// Each kind of statement says three things of itself, which all passes go by (ir/walk.hpp):
//   kParts   the expressions and the blocks that it holds, in the program's order
//   kPauses  whether it gives up the processor, so that the response goes on in a later step
//   kCells   how many cells of the frame it keeps at most: locals, counters, deadlines
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
struct Unit;  // config/units.hpp
}

namespace robosync::compiler::ir {

// ---- what is remembered

struct Variable {
  std::string name;
  vm::VariableKind kind{};
  vm::Dimension dimension{};
  const Unit* unit = nullptr;       // as it is written; null: it has none
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

// A MOTION that something performs: where each of its actuators is when.
struct Track {
  std::size_t actuator = 0;
  std::vector<vm::Key> keys;
};
struct Motion {
  std::string name;
  vm::Value length = 0;  // time of its last row
  std::vector<Track> tracks;
};

// ---- what responses do

struct Argument {
  vm::Param param{};
  Expression value;
  static constexpr std::tuple kParts{&Argument::value};
  bool operator==(const Argument&) const = default;
};

// A word or text of the first actuator it is for, which sets one parameter.
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

// One or several actuators. STOP in a response is a command with the verb STOP; STOP ALL is one for
// each actuator. PERFORM is one for all actuators of its MOTION.
struct Command {
  std::optional<std::size_t> group;    // place in Robot::groups: the target is the group …
  std::vector<std::size_t> actuators;  // … and these are its members; else exactly one
  Verb verb;
  std::optional<Word> word;
  std::vector<Argument> arguments;
  // PERFORM: the place in Program::motions of what is performed; `actuators` are all that it moves.
  std::optional<std::size_t> motion{};
  static constexpr bool kPauses = false;
  static constexpr std::size_t kCells = 0;
  static constexpr std::tuple kParts{&Command::arguments};
};

struct Statement;
using Block = std::vector<Statement>;

struct Local {  // a value that is worked out here: what a DEFINE is given
  std::size_t number = 0;
  Expression value;
  bool has_other_writers = false;  // then what it holds depends on the way there
  static constexpr bool kPauses = false;
  static constexpr std::size_t kCells = 1;
  static constexpr std::tuple kParts{&Local::value};
};
struct Set {
  std::size_t variable = 0;
  Expression value;
  bool relative = false;  // RAISE, LOWER, SIGNAL: `value` is added
  // What the optimiser has proved: the variable was written in this run already, so that it can be
  // computed where it stands; and the result may be outside of the variable's range.
  bool in_place = false;
  bool may_be_below = true, may_be_above = true;
  Fact before{};  // what the variable is before
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
// FOLLOW: the body runs in each step that may change what it reads, beginning with the next, until the
// time is over; without one, as long as the response runs. What it remembers from one run of the body to
// the next is a local that stands before it.
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
// How often it runs, when that is constant: a whole number in thousandths, 0 for never.
[[nodiscard]] std::optional<vm::Value> constant_count(const Repeat& repeat);
struct Repeat {
  RepeatKind kind{};
  Expression control;  // times: the number; while_: the condition
  Block body;
  // Variables that the body certainly writes: the optimiser has them written once before the loop
  // (to what they are), so that the body computes them in place.
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
struct Log {  // LOG, and ALERT with `alert`
  bool alert = false;
  std::string text;                // with a {} place for each value
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

// Does the statement itself give up the processor? Of a block: does a statement in it, anywhere?
[[nodiscard]] bool is_pause(const Statement& statement);
[[nodiscard]] bool pauses(const Block& block);

// ---- when they do it

struct Rule {
  vm::RuleKind kind = vm::RuleKind::when;  // when … start; safety
  Expression condition;                    // every: the period; start: none
  Block then_response;
  Block else_response;               // only of when_else
  std::optional<Expression> resume;  // of safety; nothing: only a person resumes
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

// A word that the program compares a channel with that learns its words.
struct LearnedWord {
  ChannelRef channel;
  std::string text;
};

struct Program {
  // In the order of their labels, which are yet to be given to the robot's channels.
  std::vector<LearnedWord> words;
  std::vector<Variable> variables;
  std::vector<Check> checks;
  std::vector<Motion> motions;
  std::vector<Rule> safety;
  std::vector<Behavior> behaviors;  // priorities descending, distinct
  // LIMIT … SPEED, by place in Robot::actuators; the stricter of this and the robot's own holds.
  std::vector<std::pair<std::size_t, vm::Value>> speed_limits;
  bool optimized = false;  // facts are filled in, and codegen may make use of them
  bool shares = false;     // … and work out equal parts of a condition once: frames have room
};

}  // namespace robosync::compiler::ir
