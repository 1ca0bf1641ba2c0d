#include "tests/oracles/rsl/interpreter.hpp"

#include <algorithm>

namespace robosync::oracle {
namespace {

constexpr Millis kGuardEvery = 10;

void collect(const compiler::Expression& expression, std::set<compiler::ChannelRef>& channels) {
  if (expression.operation == compiler::Operation::input) channels.insert(expression.channel);
  for (const compiler::Expression& operand : expression.operands)
    collect(operand, channels);
}

}  // namespace

Interpreter::Interpreter(const compiler::ir::Program& program, const compiler::Robot& robot,
                         std::uint32_t seed, Trace& trace)
    : program_(program),
      trace_(trace),
      no_chance_(seed, 0),
      inputs_(program, robot, trace),
      actuators_(program, robot, trace),
      actuator_count_(robot.actuators.size()) {
  const std::uint32_t first = program.safety.empty() ? 0 : 1;
  for (std::size_t rank = 0; rank < program.behaviors.size(); ++rank) {
    chances_.emplace_back(seed, first + static_cast<std::uint32_t>(rank));
    for (const compiler::ir::Rule& rule : program.behaviors[rank].rules) {
      Rule made;
      made.rule = &rule;
      made.behavior = &program.behaviors[rank];
      made.rank = rank;
      made.then_actuators = actuators_of(rule.then_response);
      made.else_actuators = actuators_of(rule.else_response);
      rules_.push_back(std::move(made));
    }
  }
  for (const compiler::ir::Rule& rule : program.safety) {
    Guard guard;
    guard.rule = &rule;
    collect(rule.condition, guard.channels);
    if (rule.resume) collect(*rule.resume, guard.channels);
    guards_.push_back(std::move(guard));
  }
}

// ---- time

void Interpreter::run(const std::vector<Reading>& readings, Millis end) {
  std::size_t next = 0;
  for (now_.at = 0; now_.at <= end; ++now_.at) {
    trace_.set_time(now_.at);
    feed(readings, next);
    guard(now_.at % kGuardEvery == 0);
    advance_actuators();
    step();
    while (somebody_could_go_on() || somebody_could_start())
      step();
  }
}

void Interpreter::feed(const std::vector<Reading>& readings, std::size_t& next) {
  // Of several readings of one channel in one millisecond the last one counts.
  std::map<compiler::ChannelRef, std::int64_t> last;
  for (; next < readings.size() && readings[next].at <= now_.at; ++next)
    last[readings[next].channel] = readings[next].value;
  std::set<compiler::ChannelRef> news;
  for (const auto& [channel, value] : last)
    if (inputs_.feed(channel, value, now_.at)) news.insert(channel);
  if (!news.empty()) guard(false, news);
}

// "What an actuator has done at a time is over before anything else of that time."
void Interpreter::advance_actuators() {
  for (std::size_t actuator = 0; actuator < actuator_count_; ++actuator)
    actuators_.advance(actuator, now_.at);
  end_responses();
}

// A response is finished when all its commands are done.
void Interpreter::end_responses() {
  for (std::size_t r = 0; r < rules_.size(); ++r) {
    Rule& rule = rules_[r];
    if (!rule.running || rule.running->rests || actuators_.works_for(r)) continue;
    if (!rule.running->response.ended() || rule.running->response.waits()) continue;
    trace_.rule("finished", *rule.rule, rule.behavior);
    // "A WHILE keeps its actuators between two rounds."
    rule.running->rests = rule.rule->kind == vm::RuleKind::while_ && rule.last == true;
    if (!rule.running->rests) rule.running.reset();
  }
}

// Actuators that became free are there for who waits for them in the same millisecond.
bool Interpreter::somebody_could_go_on() {
  for (std::size_t r = 0; r < rules_.size(); ++r)
    if (rules_[r].running && rules_[r].running->response.waits() &&
        rules_[r].running->response.may_go_on(around(r)))
      return true;
  return false;
}

bool Interpreter::somebody_could_start() const {
  for (std::size_t r = 0; r < rules_.size(); ++r) {
    std::vector<std::size_t> losers;
    const std::optional<bool> side = wish(r);
    if (side && in_the_way({r, *side, false}, losers).empty()) return true;
  }
  return false;
}

void Interpreter::step() {
  ++now_.step;
  for (Rule& rule : rules_)
    if (rule.running) rule.running->won_now = false;
  inputs_.enter(now_.at);
  remember();
  interrupt_halted();
  for (std::size_t first = 0; first < rules_.size();)
    first = take_turn(first);
  run_responses();
}

// A behaviour looks at all its rules, and then claims what they want. Returns where the next one begins.
std::size_t Interpreter::take_turn(std::size_t first) {
  std::vector<Claim> claims;
  std::size_t r = first;
  for (; r < rules_.size() && rules_[r].rank == rules_[first].rank; ++r)
    look_at(r, claims);
  for (const Claim& claim : claims)
    serve(claim);
  return r;
}

void Interpreter::remember() {
  const Sight sight{inputs_.snapshot()};
  const auto note = [&](const compiler::Expression& condition) {
    evaluator_.remember(condition, sight, now_);
  };
  for (const Rule& rule : rules_) {
    if (rule.rule->kind != vm::RuleKind::every && rule.rule->kind != vm::RuleKind::start)
      note(rule.rule->condition);
    for_each_condition(rule.rule->then_response, note);
    for_each_condition(rule.rule->else_response, note);
  }
}

// ---- responses

const std::set<std::size_t>& Interpreter::actuators(std::size_t rule, bool side) const {
  return side ? rules_[rule].then_actuators : rules_[rule].else_actuators;
}

std::string Interpreter::name_of(const Rule& rule) {
  if (!rule.behavior->name.empty()) return "behaviour " + rule.behavior->name;
  return "the rule at line " + std::to_string(rule.behavior->rules.front().line);
}

Surroundings Interpreter::around(std::size_t rule) {
  return {evaluator_, chances_[rules_[rule].rank], program_.variables, inputs_.snapshot(),
          now_.at,    !actuators_.works_for(rule)};
}

void Interpreter::run_responses() {
  std::vector<std::pair<std::size_t, Output>> outputs;
  for (std::size_t r = 0; r < rules_.size(); ++r) {
    std::optional<Running>& running = rules_[r].running;
    if (!running) continue;
    const Surroundings here = around(r);
    if (!running->won_now && (!running->response.waits() || !running->response.may_go_on(here)))
      continue;
    outputs.emplace_back(r, running->response.run(here));
    if (running->response.follows_on()) continue;
    if (!running->won_now) trace_.rule("go_on", *rules_[r].rule, rules_[r].behavior);
    const bool waited_to_its_end = !running->won_now && !running->response.waits();
    rules_[r].ran = now_.at - (waited_to_its_end ? kLeastPause : 0);
    if (running->response.waits()) trace_.rule("wait", *rules_[r].rule, rules_[r].behavior);
  }
  std::vector<Changes> changes;
  for (auto& [rule, output] : outputs) {
    carry_out(output);
    changes.push_back(std::move(output.changes));
  }
  inputs_.stage(std::move(changes));
  end_responses();
}

void Interpreter::say(const Said& said) {
  trace_.text(said.alert ? "alert" : "log", filled_in(said.text, said.values), said.values);
}

void Interpreter::carry_out(const Output& output) {
  std::set<std::size_t> started;
  std::set<std::size_t> overrun;  // which is said once a step
  for (const Effect& effect : output.effects) {
    if (const auto* said = std::get_if<Said>(&effect)) {
      say(*said);
      continue;
    }
    const auto& [targets, order] = std::get<Commanded>(effect);
    for (const std::size_t actuator : targets) {
      started.insert(actuator);
      if (actuators_.submit(actuator, order)) continue;
      if (overrun.insert(actuator).second) trace_.actuator("overrun", actuator);
    }
  }
  for (const std::size_t actuator : started)
    actuators_.start(actuator, now_.at);
}

}  // namespace robosync::oracle
