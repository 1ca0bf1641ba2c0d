#include "compiler/sema/lints.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <set>

#include <fmt/format.h>

#include "compiler/ir/walk.hpp"
#include "compiler/sema/condition_lints.hpp"
#include "compiler/sema/intervals.hpp"
#include "compiler/syntax/walk.hpp"
#include "compiler/units/units.hpp"
#include "vm/drivers.hpp"

namespace robosync::compiler {

// ---- does one condition follow from another?

namespace {

// A comparison with a constant, as the range of values for which it is true.
struct Threshold {
  const Expression* side = nullptr;
  std::int64_t low = vm::kValueMin, high = vm::kValueMax;
};

std::optional<Threshold> threshold(const Expression& condition) {
  if (condition.operands.size() != 2 || condition.operands[1].operation != Operation::constant)
    return std::nullopt;
  Threshold result{&condition.operands[0]};
  const std::int64_t number = condition.operands[1].constant;
  switch (condition.operation) {
    case Operation::less:
      result.high = number - 1;
      return result;
    case Operation::less_equal:
      result.high = number;
      return result;
    case Operation::greater:
      result.low = number + 1;
      return result;
    case Operation::greater_equal:
      result.low = number;
      return result;
    case Operation::equal:
      result.low = number;
      result.high = number;
      return result;
    default:
      return std::nullopt;
  }
}

}  // namespace

bool implies(const Expression& condition, const Expression& consequence) {
  if (draws(condition)) return false;
  if (condition == consequence) return true;
  const auto each = [&](const Expression& part) { return implies(part, consequence); };
  if (condition.operation == Operation::logical_and)
    return std::any_of(condition.operands.begin(), condition.operands.end(), each);
  // A condition that has held for some time also holds now.
  if (condition.operation == Operation::held) return each(condition.operands[0]);
  const auto narrow = threshold(condition);
  const auto wide = threshold(consequence);
  return narrow && wide && *narrow->side == *wide->side && narrow->low >= wide->low &&
         narrow->high <= wide->high;
}

// ---- W0203: the two rules that wait for a change

namespace {

std::string_view opposite_sign(ast::Relation relation) {
  switch (relation) {
    case ast::Relation::less:
      return ">=";
    case ast::Relation::less_equal:
      return ">";
    case ast::Relation::greater:
      return "<=";
    case ast::Relation::greater_equal:
      return "<";
    case ast::Relation::equal:
      return "<>";
    case ast::Relation::not_equal:
      return "=";
  }
  return "";
}

std::string text_of(const ast::Block& block, const SourceMap& sources) {
  if (block.empty()) return "";
  const Span span{block.front().span.file, block.front().span.begin, block.back().span.end};
  return std::string(sources.text(span));
}

// The heads of two rules that wait for a change.
struct TwoRules {
  std::string then_head, else_head;
};

// For `channel < number`, with a channel that rests at 0.
std::optional<TwoRules> rules_without_start(const ast::WhenRule& when, const Names& names,
                                            const Typed& condition, const SourceMap& sources) {
  const auto* comparison = std::get_if<ast::Comparison>(&when.condition->node);
  if (comparison == nullptr || condition.code.operands.size() != 2) return std::nullopt;
  const Expression& left = condition.code.operands[0];
  const Expression& right = condition.code.operands[1];
  const bool below = comparison->relation == ast::Relation::less ||
                     comparison->relation == ast::Relation::less_equal;
  if (!below || left.operation != Operation::input || right.operation != Operation::constant ||
      names.channel(left.channel).min != 0 || right.constant <= 0)
    return std::nullopt;
  const std::string channel(sources.text(comparison->left->span));
  const std::string number(sources.text(comparison->right->span));
  const std::string whole(sources.text(when.condition->span));
  return TwoRules{
      "WHEN " + channel + " > 0 AND " + whole,
      "WHEN " + channel + " " + std::string(opposite_sign(comparison->relation)) + " " + number};
}

}  // namespace

void lint_start(const ast::Rule& rule, const ast::WhenRule& when, const Names& names,
                const Typed& condition, const SourceMap& sources, Diagnostics& diagnostics) {
  Diagnostic& d =
      diagnostics.report(Code::W0203, "this rule acts at start: the first reading chooses a side")
          .label(rule.head_span);
  const auto rules = rules_without_start(when, names, condition, sources);
  if (!rules) {
    d.helps("to wait for a change, write a WHEN without ELSE for each side");
    return;
  }
  d.helps("to wait for a change, write two rules: `" + rules->then_head + "` and `" +
          rules->else_head + "`")
      .fix(rule.span,
           rules->then_head + "\nDO\n" + text_of(when.then_block, sources) + "\nEND\n\n" +
               rules->else_head + "\nDO\n" + text_of(*when.else_block, sources) + "\nEND",
           Applicability::likely);
}

// ---- W0201: the bands of a CHECK against its sensor's range

namespace {

bool overlaps(const Intervals& ranges, const Interval& wanted) {
  return std::any_of(ranges.begin(), ranges.end(), [&](const Interval& range) {
    return range.low <= wanted.high && wanted.low <= range.high;
  });
}

}  // namespace

namespace {

// W0210: a band that is never left once it is entered.
void lint_hold(const ast::Check& node, const ir::Check& check, const Typed& input,
               Diagnostics& diagnostics) {
  for (std::size_t i = 0; i < check.bands.size() && node.margin; ++i) {
    const vm::Band& band = check.bands[i];
    const bool has_all = band.low <= input.low && band.high >= input.high;
    const bool has_some = band.low <= input.high && band.high >= input.low;
    if (has_all || !has_some || band.stay_low > input.low || band.stay_high < input.high) continue;
    diagnostics
        .report(Code::W0210, "once " + node.name.shown() + " is " + node.bands[i].label.shown() +
                                 ", it stays so: no value gets past its limit by the MARGIN")
        .label(node.margin->span)
        .label(node.bands[i].span, "this band", false);
    return;
  }
}

}  // namespace

void lint_bands(const ast::Check& node, const ir::Check& check, const Typed& input,
                Diagnostics& diagnostics) {
  const Unit& unit = input.unit != nullptr ? *input.unit : canonical_unit(vm::Dimension::number);
  lint_hold(node, check, input, diagnostics);
  Intervals left{{input.low, input.high}};
  for (std::size_t i = 0; i < check.bands.size(); ++i) {
    const Interval band{check.bands[i].low, check.bands[i].high};
    if (!overlaps(left, band))
      diagnostics
          .report(Code::W0201, node.name.shown() + " is never " + node.bands[i].label.shown())
          .label(node.bands[i].span,
                 "the bands above it, or the sensor's range, leave it no values");
    left = without(left, band);
  }
  if (left.empty()) return;
  const auto [low, high] = left.front();
  const std::string from = format_value(low, unit);
  const std::string gap =
      low == high ? "at exactly " + from : "from " + from + " to " + format_value(high, unit);
  diagnostics.report(Code::W0201, gap + ", " + node.name.shown() + " is unknown")
      .label(node.name.span)
      .helps("add a band OTHERWISE, or close the gap between two bands");
}

// ---- W0202, W0204, W0207: rules compared with each other, and with their own responses

namespace {

std::set<std::size_t> actuators_of(const ir::Rule& rule) {
  std::set<std::size_t> result;
  for_each_response(rule, [&](const ir::Block& block) {
    for_each_of<ir::Command>(block, [&](const ir::Command& command) {
      result.insert(command.actuators.begin(), command.actuators.end());
    });
  });
  return result;
}

// ---- W0202

// Does `higher` own its actuators whenever `lower` could start?
bool always_before(const ir::Rule& higher, const ir::Rule& lower) {
  if (higher.cooldown != 0 || lower.waiting != 0) return false;
  if (lower.kind != vm::RuleKind::when && lower.kind != vm::RuleKind::while_) return false;
  if (higher.kind == vm::RuleKind::while_) return implies(lower.condition, higher.condition);
  // Both would start in the same step; after that, the lower rule's moment has passed.
  return higher.kind == vm::RuleKind::when && lower.kind == vm::RuleKind::when &&
         lower.cooldown == 0 && implies(lower.condition, higher.condition) &&
         implies(higher.condition, lower.condition);
}

struct KnownRule {
  const ir::Rule* rule = nullptr;
  std::set<std::size_t> actuators;
};

// The most pairs of rules checked in one program; more than the rules in a robot's memory can form.
constexpr std::size_t kMostPairs = 500'000;

bool share(const std::set<std::size_t>& a, const std::set<std::size_t>& b) {
  auto at_a = a.begin(), at_b = b.begin();
  while (at_a != a.end() && at_b != b.end()) {
    if (*at_a == *at_b) return true;
    ++(*at_a < *at_b ? at_a : at_b);
  }
  return false;
}

void lint_order(const LintInput& input) {
  std::vector<KnownRule> higher;
  std::size_t pairs = 0;
  for (const ir::Behavior& behavior : input.program.behaviors) {
    std::vector<KnownRule> own;
    for (const ir::Rule& rule : behavior.rules) {
      pairs += higher.size();
      if (pairs > kMostPairs) return;
      KnownRule known{&rule, actuators_of(rule)};
      const auto first = std::find_if(higher.begin(), higher.end(), [&](const KnownRule& other) {
        return share(other.actuators, known.actuators) && always_before(*other.rule, rule);
      });
      if (first != higher.end())
        input.diagnostics
            .report(Code::W0202,
                    "this rule never runs: a more important one uses its actuator "
                    "whenever this one could")
            .label(rule.span)
            .label(first->rule->span, "this one", false);
      own.push_back(std::move(known));
    }
    std::move(own.begin(), own.end(), std::back_inserter(higher));
  }
}

// ---- W0204

// The shortest time that a response takes, in milliseconds: its waits and the durations of its commands.
class Duration {
public:
  std::int64_t of(const ir::Block& block) {
    add(block);
    return std::max(now_, latest());
  }
  std::int64_t waits_of(const ir::Block& block) {
    add(block);
    return now_;
  }

private:
  void add(const ir::Block& block) {
    for (const ir::Statement& statement : block) {
      if (const auto* command = std::get_if<ir::Command>(&statement.node)) add(*command);
      if (const auto* wait = std::get_if<ir::Wait>(&statement.node))
        now_ += std::max<std::int64_t>(constant(wait->duration), 0);
      const auto* follow = std::get_if<ir::Follow>(&statement.node);
      if (follow != nullptr && follow->lasts)
        now_ += std::max<std::int64_t>(constant(*follow->lasts), 0);
      if (std::holds_alternative<ir::Then>(statement.node)) now_ = std::max(now_, latest());
    }
  }

  void add(const ir::Command& command) {
    std::int64_t takes = 0;
    for (const ir::Argument& argument : command.arguments)
      if (argument.param == vm::Param::over || argument.param == vm::Param::for_)
        takes = std::max<std::int64_t>(takes, constant(argument.value));
    for (const std::size_t actuator : command.actuators)
      busy_[actuator] = std::max(busy_[actuator], now_) + takes;
  }

  static std::int64_t constant(const Expression& expression) {
    return expression.operation == Operation::constant ? expression.constant : 0;
  }

  [[nodiscard]] std::int64_t latest() const {
    std::int64_t result = 0;
    for (const auto& [actuator, until] : busy_)
      result = std::max(result, until);
    return result;
  }

  std::int64_t now_ = 0;
  std::map<std::size_t, std::int64_t> busy_;
};

void lint_cooldown(const ir::Rule& rule, Diagnostics& diagnostics) {
  if (rule.cooldown == 0 || rule.restarting) return;
  const std::int64_t takes = Duration().of(rule.then_response);
  if (takes <= rule.cooldown) return;
  const Unit& second = canonical_unit(vm::Dimension::duration);
  diagnostics
      .report(Code::W0204, "the COOLDOWN ends before the response: the response takes " +
                               format_value(takes, second) + ", the COOLDOWN " +
                               format_value(rule.cooldown, second))
      .label(rule.span)
      .helps("a COOLDOWN counts from the start of the response; make it longer than that");
}

// What the response waits for itself: commands go on in the background.
void lint_period(const ir::Rule& rule, Diagnostics& diagnostics) {
  const std::int64_t period = rule.condition.constant;
  if (rule.kind != vm::RuleKind::every || rule.waiting != 0 || period <= 0 ||
      rule.condition.operation != Operation::constant)
    return;
  const std::int64_t waits = Duration().waits_of(rule.then_response);
  if (waits < period) return;
  const Unit& second = canonical_unit(vm::Dimension::duration);
  diagnostics
      .report(Code::W0204, fmt::format("this is not done every {}, but every {}: its WAITs take {}",
                                       format_value(period, second),
                                       format_value((waits / period + 1) * period, second),
                                       format_value(waits, second)))
      .label(rule.span)
      .helps("make the period longer: one that comes while the response still runs is left out");
}

// ---- W0207

bool never_ends(const ir::Rule& rule) {
  return std::any_of(
      rule.then_response.begin(), rule.then_response.end(), [&](const ir::Statement& statement) {
        const auto* follow = std::get_if<ir::Follow>(&statement.node);
        if (follow != nullptr) return !follow->lasts;
        const auto* loop = std::get_if<ir::Repeat>(&statement.node);
        if (loop == nullptr) return false;
        return loop->kind == ir::RepeatKind::forever ||
               (loop->kind == ir::RepeatKind::while_ && loop->control == rule.condition);
      });
}

void lint_level(const ir::Rule& rule, Diagnostics& diagnostics) {
  if (rule.kind != vm::RuleKind::when || !never_ends(rule)) return;
  diagnostics
      .report(Code::W0207,
              "this goes on even if the condition no longer holds: WHEN only starts it")
      .label(rule.span)
      .helps("WHILE repeats its response as long as the condition holds, and then ends it");
}

// ---- W0219

// A command takes time, except STOP and a level that an output takes on immediately (vm/drivers.def).
bool takes_time(const ir::Command& command, const Names& names) {
  const bool lasts = std::any_of(
      command.arguments.begin(), command.arguments.end(), [](const ir::Argument& argument) {
        return argument.param == vm::Param::over || argument.param == vm::Param::for_;
      });
  const bool at_once = std::all_of(
      command.actuators.begin(), command.actuators.end(),
      [&](std::size_t actuator) { return vm::gives_power(names.actuator(actuator).driver); });
  return command.verb.action != vm::Action::stop && (lasts || !at_once);
}

bool takes_time(const ir::Block& block, const Names& names) {
  bool found = false;
  for_each_statement(block, [&](const ir::Statement& statement) {
    const auto* const command = std::get_if<ir::Command>(&statement.node);
    found = found || std::holds_alternative<ir::Wait>(statement.node) ||
            std::holds_alternative<ir::WaitUntil>(statement.node) ||
            std::holds_alternative<ir::Follow>(statement.node) ||
            (command != nullptr && takes_time(*command, names));
  });
  return found;
}

void lint_length(const ir::Rule& rule, const Names& names, Diagnostics& diagnostics) {
  if (rule.kind != vm::RuleKind::while_ || rule.cooldown > 0) return;
  if (takes_time(rule.then_response, names)) return;
  diagnostics.report(Code::W0219, "this runs 50 times a second: its response takes no time")
      .label(rule.span)
      .helps("use EVERY with an IF in it, or end the response with a WAIT");
}

}  // namespace

void lint_rules(const LintInput& input) {
  lint_order(input);
  for (const ir::Behavior& behavior : input.program.behaviors) {
    for (const ir::Rule& rule : behavior.rules) {
      lint_cooldown(rule, input.diagnostics);
      lint_period(rule, input.diagnostics);
      lint_level(rule, input.diagnostics);
      lint_length(rule, input.names, input.diagnostics);
    }
  }
}

// ---- W0205: a WAIT UNTIL that may wait for ever and holds its actuators meanwhile

namespace {

void lint_block(const ast::Block& block, Diagnostics& diagnostics) {
  for_each_statement(block, [&](const ast::Stmt& stmt) {
    const auto* wait = std::get_if<ast::WaitUntil>(&stmt.node);
    if (wait == nullptr || wait->within != nullptr) return;
    diagnostics.report(Code::W0205, "this may wait for ever, and its response keeps its actuators")
        .label(stmt.span)
        .helps("limit the wait: `WITHIN 10s`")
        .fix({stmt.span.file, stmt.span.end, stmt.span.end}, " WITHIN 10s",
             Applicability::placeholder);
  });
}

}  // namespace

void lint_waits(const LintInput& input) {
  const auto lint = [&](const ast::Block& block) { lint_block(block, input.diagnostics); };
  for (const ast::Item& item : input.tree.items) {
    if (const auto* define = std::get_if<ast::Define>(&item.node)) lint(define->body);
    if (const auto* rule = std::get_if<ast::Rule>(&item.node)) for_each_block(*rule, lint);
    if (const auto* behavior = std::get_if<ast::Behavior>(&item.node))
      for (const ast::Rule& rule : behavior->rules)
        for_each_block(rule, lint);
  }
}

// ---- W0206, W0211: names and labels that nothing uses or sets

namespace {

using Entered = std::map<std::size_t, std::set<vm::Value>>;  // labels set, by variable

Entered labels_set(const ir::Program& program) {
  Entered result;
  for_each_rule(program, [&](const ir::Rule& rule) {
    for_each_response(rule, [&](const ir::Block& block) {
      for_each_of<ir::Set>(block, [&](const ir::Set& set) {
        if (program.variables[set.variable].kind == vm::VariableKind::state)
          result[set.variable].insert(set.value.constant);
      });
    });
  });
  return result;
}

void lint_state(const ast::State& state, const std::set<vm::Value>& entered,
                Diagnostics& diagnostics) {
  if (entered.empty()) {
    diagnostics.report(Code::W0206, "nothing ever sets " + state.name.shown())
        .label(state.name.span);
    return;
  }
  for (std::size_t i = 0; i < state.labels.size(); ++i) {
    const ast::Name& label = state.labels[i];
    const bool set = entered.contains(static_cast<vm::Value>(i) * vm::kScale);
    if (!set && i != 0)
      diagnostics.report(Code::W0206, state.name.shown() + " is never set to " + label.shown())
          .label(label.span);
    else if (set && entered.size() == 1)
      diagnostics
          .report(Code::W0206, "once " + state.name.shown() + " is " + label.shown() +
                                   ", nothing sets it to anything else")
          .label(label.span);
  }
}

void lint_unused(const LintInput& input) {
  for (const auto& [folded, define] : input.names.defines())
    if (!define.used && !define.in_module)
      input.diagnostics.report(Code::W0211, "nothing runs " + define.define->name.shown())
          .label(define.span);
  for (const auto& [folded, constant] : input.names.constants())
    if (!constant.used && !constant.in_module)
      input.diagnostics.report(Code::W0211, "nothing uses " + constant.let->name.shown())
          .label(constant.let->name.span);
  for (const VariableName& variable : input.names.variables())
    if (variable.kind == vm::VariableKind::signal && !variable.heard && !variable.in_module)
      input.diagnostics.report(Code::W0211, "no rule asks for the signal " + variable.name.shown())
          .label(variable.name.span)
          .helps("to react to it, write `WHEN " + std::string(variable.name.text) + "`");
}

void lint_remember(const VariableName& variable, Diagnostics& diagnostics) {
  if (!variable.fixed) return;
  diagnostics.report(Code::W0206, "nothing ever sets " + variable.name.shown())
      .label(variable.name.span)
      .helps("a number that stays the same is a LET: `LET " + std::string(variable.name.text) +
             " = " + format_value(*variable.fixed, *variable.unit) + "`");
}

}  // namespace

void lint_names(const LintInput& input) {
  lint_unused(input);
  const Entered entered = labels_set(input.program);
  for (const VariableName& variable : input.names.variables()) {
    if (variable.in_module) continue;
    lint_remember(variable, input.diagnostics);
    const auto* state = std::get_if<const ast::State*>(&variable.declared);
    if (state == nullptr) continue;
    const auto found = entered.find(variable.index);
    lint_state(**state, found == entered.end() ? std::set<vm::Value>{} : found->second,
               input.diagnostics);
  }
}

// ---- W0208, W0209, W0218: the program compared with its robot

namespace {

bool is_order(Operation operation) {
  return operation == Operation::less || operation == Operation::less_equal ||
         operation == Operation::greater || operation == Operation::greater_equal;
}

// A measurement in a real unit fluctuates; "change" in robot.json suppresses small steps.
bool is_noisy(const ChannelConfig& channel) {
  return channel.unit->dimension != vm::Dimension::number && channel.change == 0;
}

// The first unfiltered reading of a noisy sensor that is compared with a constant.
const Expression* raw_threshold(const Expression& condition, const Names& names) {
  if (condition.operation == Operation::latch || condition.operation == Operation::held)
    return nullptr;
  if (is_order(condition.operation)) {
    const bool fixed =
        std::any_of(condition.operands.begin(), condition.operands.end(),
                    [](const Expression& side) { return side.operation == Operation::constant; });
    for (const Expression& side : condition.operands)
      if (fixed && side.operation == Operation::input && is_noisy(names.channel(side.channel)))
        return &side;
    return nullptr;
  }
  for (const Expression& operand : condition.operands)
    if (const Expression* found = raw_threshold(operand, names)) return found;
  return nullptr;
}

void lint_noise(const LintInput& input) {
  for (const ir::Behavior& behavior : input.program.behaviors) {
    for (const ir::Rule& rule : behavior.rules) {
      if (rule.kind == vm::RuleKind::every || rule.kind == vm::RuleKind::start) continue;
      const Expression* reading = raw_threshold(rule.condition, input.names);
      if (reading == nullptr) continue;
      const std::string name = input.names.channel_name(reading->channel);
      input.diagnostics
          .report(Code::W0208,
                  "`" + name +
                      "` may fluctuate around this number and trigger the rule again and again")
          .label(rule.span)
          .helps("give the rule a MARGIN, or use a CHECK with SMOOTH of `" + name + "`");
    }
  }
}

// PERFORM and FOLLOW are not verbs of their actuators, and they can also control lamps.
bool moves_them(const ir::Command& command) {
  const vm::Action action = command.verb.action;
  return action != vm::Action::stop && action != vm::Action::play &&
         (action != vm::Action::set ||
          (command.verb.takes >> static_cast<unsigned>(vm::Param::direction) & 1U) != 0);
}

// The actuators that a SAFETY rule or a LIMIT can stop.
std::set<std::size_t> stopped_ones(const LintInput& input) {
  std::set<std::size_t> stopped;
  for (const auto& [actuator, speed] : input.program.speed_limits)
    stopped.insert(actuator);
  for (const ir::Rule& rule : input.program.safety)
    for_each_of<ir::Halt>(rule.then_response, [&](const ir::Halt& halt) {
      for (std::size_t i = 0; halt.all && i < input.robot.actuators.size(); ++i)
        stopped.insert(i);
      stopped.insert(halt.actuators.begin(), halt.actuators.end());
    });
  return stopped;
}

// A few rules without a BEHAVIOR are a first try and get no advice, until there is a SAFETY rule.
void lint_safety(const LintInput& input) {
  const ir::Program& program = input.program;
  const std::set<std::size_t> stopped = stopped_ones(input);
  std::set<std::size_t> found;
  Span first{};
  const auto note = [&](const ir::Rule& rule, const ir::Command& command) {
    for (const std::size_t actuator : command.actuators) {
      if (!moves_them(command) || !input.robot.actuators[actuator].moves() ||
          stopped.contains(actuator))
        continue;
      if (found.empty()) first = rule.span;
      found.insert(actuator);
    }
  };
  for (const ir::Behavior& behavior : program.behaviors)
    for (const ir::Rule& rule : behavior.rules)
      for_each_response(rule, [&](const ir::Block& block) {
        if (!behavior.name.empty() || !stopped.empty())
          for_each_of<ir::Command>(block, [&](const auto& command) { note(rule, command); });
      });
  if (found.empty()) return;
  std::vector<std::string> names;
  names.reserve(found.size());
  for (const std::size_t actuator : found)
    names.push_back(input.robot.actuators[actuator].name.text);
  input.diagnostics
      .report(Code::W0209, stopped.empty() ? "this robot moves, and no SAFETY rule can stop it"
                                           : "no SAFETY rule can stop " + list_names(names))
      .label(first, "the first rule that moves it")
      .helps(stopped.empty() ? "add a SAFETY rule, or a LIMIT on its speed"
                             : "add a STOP to a SAFETY rule, or a LIMIT on its speed");
}

}  // namespace

void lint_robot(const LintInput& input) {
  if (input.program.behaviors.empty() && input.program.safety.empty())
    input.diagnostics.report(Code::W0218, "there is no rule: the robot does nothing").label({});
  lint_noise(input);
  lint_safety(input);
}

}  // namespace robosync::compiler
