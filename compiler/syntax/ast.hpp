// The tree of an RSL program, for the whole language (docs/language.md). Every node has a span.
//
// The parser builds it and sema reads it. Nothing is resolved here: names are text, numbers are as
// written. Bison's variants need values that can be moved and default-constructed, hence `Box`.
// Expressions are at most 100 levels deep and blocks 32, so recursion over a tree is safe. A large program has many small
// nodes: rarely used members are in a Box; names, texts and numbers are views of the source, which outlives its tree.
// A missing name, number or text has an empty text: it has been reported already.
#pragma once

#include <cstdint>
#include <forward_list>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <variant>
#include <vector>

#include "compiler/source/source_file.hpp"

namespace robosync::compiler::ast {

template <typename T>
using Box = std::unique_ptr<T>;

struct Name {
  std::string_view text;
  Span span;

  // As messages show it: "`wave`".
  [[nodiscard]] std::string shown() const { return "`" + std::string(text) + "`"; }
};

// ---- expressions

struct Expr;

struct Quantity {           // 15, 0.5, 80cm, 40%
  std::string_view digits;  // as written: "0.5"
  std::string_view unit;    // as written; empty without one
  Span unit_span;
};

struct Operand {  // touchLevel, touch LEVEL, mood
  Name name;
  Box<Name> channel;  // may be null
};

struct Negate {
  Box<Expr> value;
};

enum class ArithmeticOp : std::uint8_t { add, sub, mul, div, mod };
struct Arithmetic {
  ArithmeticOp op{};
  Box<Expr> left, right;
};

struct Random {
  Box<Expr> low, high;
};

struct Function {  // ABS(x), MIN(x, y): its name is not a word of the grammar
  Name name;
  Box<Expr> first, second;  // second may be null
};

struct ItemOf {  // ITEM index OF list
  Box<Expr> index;
  Name list;
};
struct CountOf {  // COUNT OF list
  Name list;
};

enum class Relation : std::uint8_t { less, greater, less_equal, greater_equal, equal, not_equal };
struct Comparison {
  Relation relation{};
  Span relation_span;
  Box<Expr> left, right;
};

struct Is {  // grip IS [NOT] very close, WORD IS "stop"
  Box<Expr> value;
  bool negated = false;
  Name label;  // the words of a label, joined by one space
  bool is_string = false;
};

struct IsBetween {
  Box<Expr> value, low, high;
};

struct IsTruth {
  Box<Expr> value;
  bool truth = true;
};

struct Becomes {
  Box<Expr> value;
  Name label;
};

struct Changes {
  Box<Expr> value;
  Box<Expr> by;  // may be null
};

struct Not {
  Box<Expr> value;
};

enum class LogicOp : std::uint8_t { and_, or_ };
struct Logic {
  LogicOp op{};
  Box<Expr> left, right;
};

// Time words; only where the grammar has `timed`.
struct For {
  Box<Expr> condition, duration;
};
struct ThenWithin {
  Box<Expr> first, second, within;
};
struct TimesWithin {
  Box<Expr> condition;
  std::uint32_t times = 0;
  Box<Expr> within;
};

struct Expr {
  Span span;
  std::variant<Quantity, Operand, Negate, Arithmetic, Random, Function, ItemOf, CountOf, Comparison,
               Is, IsBetween, IsTruth, Becomes, Changes, Not, Logic, For, ThenWithin, TimesWithin>
      node;
  std::uint16_t depth = 1;  // levels of expressions from here down; the parser limits it
};

// ---- statements

// Each kind of statement lists the blocks that it holds in kBlocks, for syntax/walk.hpp.
struct Stmt;
using Block = std::vector<Stmt>;

enum class Preposition : std::uint8_t { none, to, by, over, at, for_, margin };

struct Word {  // SLOWLY
  Name name;
};
struct Text {  // "greeting.wav", without its quotes
  std::string_view text;
};
struct Amount {  // 15cm, 1 TIMES, a number after a preposition, a value after WITH
  Box<Expr> value;
  bool times = false;
};
struct Argument {  // of a command
  Span span;
  Preposition preposition = Preposition::none;
  std::variant<Word, Text, Amount> value;
};

// `verb carg carg …`, or `name` alone: sema decides whether that is a DEFINE or a verb.
struct Command {
  Name verb;
  std::vector<Argument> arguments;
  std::size_t parts =
      0;  // how many arguments at the end form one text with commas; 0: there is no comma
  std::optional<Span> with{};  // WITH, which no command takes; sema reports it
  static constexpr std::tuple<> kBlocks{};
};
struct Call {  // name WITH …
  Name name;
  std::vector<Argument> arguments;
  static constexpr std::tuple<> kBlocks{};
};
struct Set {
  Name name;
  Box<Expr> value;
  static constexpr std::tuple<> kBlocks{};
};
struct Raise {  // RAISE, and LOWER with `lower`
  Name name;
  Box<Expr> by;
  bool lower = false;
  static constexpr std::tuple<> kBlocks{};
};
struct Wait {
  Box<Expr> duration;
  static constexpr std::tuple<> kBlocks{};
};
struct WaitUntil {
  Box<Expr> condition;
  Box<Expr> within;  // may be null
  static constexpr std::tuple<> kBlocks{};
};
struct Then {
  static constexpr std::tuple<> kBlocks{};
};
struct If {
  Box<Expr> condition;
  Block then_block, else_block;
  static constexpr std::tuple kBlocks{&If::then_block, &If::else_block};
};
struct Repeat {  // times or condition is set; neither: FOREVER
  Box<Expr> times, condition;
  Block body;
  static constexpr std::tuple kBlocks{&Repeat::body};
};
struct Option {
  Span span;
  Box<Expr> weight;  // may be null
  Block body;
  static constexpr std::tuple kBlocks{&Option::body};
};
struct PickOne {
  std::vector<Option> options;
  static constexpr std::tuple kBlocks{&PickOne::options};
};
struct Stop {
  std::optional<Name> name;  // nothing: ALL
  static constexpr std::tuple<> kBlocks{};
};
struct Signal {
  Name name;
  static constexpr std::tuple<> kBlocks{};
};
struct Log {  // LOG, and ALERT with `alert`
  bool alert = false;
  std::vector<Argument> arguments;
  static constexpr std::tuple<> kBlocks{};
};

struct Stmt {
  Span span;
  std::variant<Command, Call, Set, Raise, Wait, WaitUntil, Then, If, Repeat, PickOne, Stop, Signal,
               Log>
      node;
};

// ---- items

struct Modifiers {
  std::optional<Name> priority;  // the digits
  Box<Expr> cooldown, margin, waiting;
  bool restarting = false;
};

struct WhenRule {
  Box<Expr> condition;
  Block then_block;
  std::optional<Block> else_block;
};
struct WhileRule {
  Box<Expr> condition;
  Block body;
};
struct EveryRule {
  Box<Expr> period, to;  // `to` may be null
  Block body;
};
struct AtStartRule {
  Block body;
};
struct Rule {
  Span span;       // from the first keyword to END
  Span head_span;  // the first keyword
  Modifiers modifiers;
  std::variant<WhenRule, WhileRule, EveryRule, AtStartRule> node;
};

struct Use {
  Name module;  // empty if this is not a USE
  bool is_string = false;
  bool is_guess =
      false;  // the word USE is missing, so an unknown module of this name is not reported
};
struct Let {
  Name name;
  Box<Expr> value;
};
struct Remember {
  Name name;
  Box<Expr> value;
  std::optional<Span> kept;  // KEPT
};
struct State {
  Name name;
  std::vector<Name> labels;
};
struct Timer {
  Name name;
};
struct List {
  Name name;
  std::vector<Argument> items;
};
struct Feeling {
  Name name;
  Box<Expr> from, to, start;
  Box<Expr> fades_to, fades_over;  // both or neither
};
struct Limit {
  Name actuator, channel;
  Box<Expr> value;
};

enum class BandKind : std::uint8_t { below, above, between, otherwise };
struct Band {
  Span span;
  Name label;
  BandKind kind{};
  Box<Expr> low, high;  // below: high; above: low; between: both
};
struct Check {
  Name name;
  Box<Expr> operand;
  std::vector<Band> bands;
  Box<Expr> margin, smooth;  // may be null
};

struct Define {
  Name name;
  std::vector<Name> parameters;
  Block body;
};
// One cell of a MOTION: the actuator's position at that time; nothing ("-"): still moving.
struct MotionKey {
  Span span;
  Box<Expr> value;
};
struct MotionRow {
  Span span;
  Box<Expr> time;
  std::vector<MotionKey> keys;
};
struct Motion {
  Name name;
  std::vector<Name> columns;  // actuators, or groups
  std::vector<MotionRow> rows;
};
struct Behavior {
  Name name;
  std::optional<Name> priority;  // the digits; nothing: robot.json gives it
  std::vector<Remember> variables;
  std::vector<Rule> rules;
};
struct Safety {
  Name name;
  Box<Expr> condition;
  Modifiers modifiers;
  Block body;
  Box<Expr> resume;  // may be null
};

struct TestFeed {
  Box<Expr> at;
  Operand target;
  Box<Expr> value;           // a number, or an IsTruth without value for TRUE/FALSE
  std::optional<Name> text;  // instead of a value: without its quotes; the span includes them
};
struct ExpectCommand {
  bool no = false;
  Command command;
  Box<Expr> within;  // null only for STOPPED: now
  Box<Name> times;   // the digits; null: once or more
};
struct ExpectText {
  bool no = false;
  bool alert = false;  // else LOG
  std::string_view text;
  Box<Expr> within;  // may be null: now
};
struct ExpectNothing {
  Box<Expr> duration;
};
struct ExpectThat {
  Box<Expr> condition;
  Box<Expr> within;  // may be null
};
struct Seed {
  Name number;  // the digits
};
struct TestStep {
  Span span;
  std::variant<TestFeed, ExpectCommand, ExpectText, ExpectNothing, ExpectThat, Wait, Seed> node;
};
struct Test {
  std::string_view title;
  std::vector<TestStep> steps;
};

struct Item {
  Span span;
  std::variant<Use, Let, Remember, State, Timer, List, Feeling, Limit, Check, Define, Motion,
               Behavior, Rule, Safety, Test>
      node;
};

struct Tree {
  std::vector<Item> items;
  std::vector<Span> keyword_names;  // names that are keywords elsewhere, in the order of the text
  std::forward_list<std::string> labels;  // those that differ from the source: `very   close`
};

}  // namespace robosync::compiler::ast
