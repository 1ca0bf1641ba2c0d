// The triggers of rules, and who gets the actuators: docs/language.md, WHEN to EVERY, COOLDOWN,
// RESTARTING, WAITING, BEHAVIOR.
#include <algorithm>

#include "tests/oracles/rsl/interpreter.hpp"

namespace robosync::oracle {

// ---- triggers

void Interpreter::look_at(std::size_t r, std::vector<Claim>& claims) {
  Rule& rule = rules_[r];
  const std::size_t before = claims.size();
  switch (rule.rule->kind) {
    case vm::RuleKind::while_:
      look_at_while(r, claims);
      break;
    case vm::RuleKind::every:
      look_at_every(r, claims);
      break;
    case vm::RuleKind::start:
      if (now_.step == 1) trigger(r, true, claims);
      break;
    default:
      look_at_when(r, claims);
      break;
  }
  if (claims.size() > before) {
    rule.waiting.reset();
  } else if (const std::optional<bool> side = wish(r)) {
    claims.push_back({r, *side, false});
  }
}

std::optional<bool> Interpreter::wish(std::size_t r) const {
  const Rule& rule = rules_[r];
  // "20 ms after it began", or "after the interruption at the earliest".
  const bool in_wait = rule.running && rule.running->response.waits_for_time();
  if (!in_wait && now_.at < rule.ran + kLeastPause) return std::nullopt;
  if (rule.waiting && now_.at <= rule.waiting->until) return rule.waiting->side;
  if (rule.rule->kind == vm::RuleKind::when_else && rule.last && rule.ran_side != rule.last)
    return cools(rule, *rule.last) ? std::nullopt : rule.last;
  const bool wants = rule.rule->kind == vm::RuleKind::while_ && rule.last == true;
  const bool free = !rule.running || rule.running->rests;
  return wants && free && !cools(rule, true) ? std::optional(true) : std::nullopt;
}

bool Interpreter::cools(const Rule& rule, bool side) const {
  const auto started = rule.started.find(side);
  return started != rule.started.end() && now_.at < started->second + rule.rule->cooldown;
}

// "After the response has started, further triggers are dropped until the time is over. Each
// side cools down by itself."
void Interpreter::trigger(std::size_t r, bool side, std::vector<Claim>& claims) {
  const Rule& rule = rules_[r];
  if (cools(rule, side)) return;
  trace_.rule("fire", *rule.rule, rule.behavior, side);
  claims.push_back({r, side, true});
}

void Interpreter::look_at_when(std::size_t r, std::vector<Claim>& claims) {
  Rule& rule = rules_[r];
  const Sight sight{inputs_.snapshot()};
  const Truth truth = evaluator_.truth(rule.rule->condition, sight);
  if (!truth) return;
  const bool change = rule.last != truth || (*truth && evaluator_.happens(rule.rule->condition));
  const bool has_else = rule.rule->kind == vm::RuleKind::when_else;
  if (change && (*truth || has_else)) trigger(r, *truth, claims);
  rule.last = truth;
}

void Interpreter::look_at_while(std::size_t r, std::vector<Claim>& claims) {
  Rule& rule = rules_[r];
  const Truth truth = evaluator_.truth(rule.rule->condition, Sight{inputs_.snapshot()});
  const bool rises = truth == true && rule.last != true;
  rule.last = truth == true;
  if (truth != true) {
    if (rule.running) interrupt(r, name_of(rule));
    return;
  }
  if (rises) trigger(r, true, claims);
}

void Interpreter::look_at_every(std::size_t r, std::vector<Claim>& claims) {
  Rule& rule = rules_[r];
  const auto next = [&](Millis from) {
    const Sight sight{inputs_.snapshot(), nullptr, nullptr, &chances_[rule.rank]};
    const Number period = evaluator_.number(rule.rule->condition, sight);
    rule.due = period ? std::optional(from + *period) : std::nullopt;
  };
  if (!rule.due) return next(now_.at);
  if (now_.at < *rule.due) return;
  trigger(r, true, claims);
  next(*rule.due);
}

// ---- who gets the actuators

void Interpreter::serve(const Claim& claim) {
  Rule& rule = rules_[claim.rule];
  if (rule.running && !rule.running->rests) {
    if (rule.running->side == claim.side && !rule.rule->restarting) {
      trace_.rule("lose", *rule.rule, rule.behavior, claim.side, name_of(rule));
      return;
    }
    interrupt(claim.rule, name_of(rule));
  }
  std::vector<std::size_t> losers;
  const std::string obstacle = in_the_way(claim, losers);
  if (!obstacle.empty()) {
    if (!claim.trigger) return;
    trace_.rule("lose", *rule.rule, rule.behavior, claim.side, obstacle);
    const bool chooses = rule.rule->kind == vm::RuleKind::when_else;  // it goes on wanting anyway
    if (chooses) rule.ran_side.reset();
    if (rule.rule->waiting > 0 && !chooses)
      rule.waiting = Waiting{claim.side, now_.at + rule.rule->waiting};
    return;
  }
  for (const std::size_t loser : losers)
    interrupt(loser, name_of(rule));
  trace_.rule("win", *rule.rule, rule.behavior, claim.side);
  const auto& block = claim.side ? rule.rule->then_response : rule.rule->else_response;
  rule.running =
      Running{Response(block, claim.rule), claim.side, actuators(claim.rule, claim.side), true};
  rule.waiting.reset();
  rule.started[claim.side] = now_.at;
  rule.ran_side = claim.side;
}

std::string Interpreter::in_the_way(const Claim& claim, std::vector<std::size_t>& losers) const {
  const Rule& rule = rules_[claim.rule];
  const std::set<std::size_t>& wanted = actuators(claim.rule, claim.side);
  const auto shares = [&](const std::set<std::size_t>& other) {
    return std::any_of(wanted.begin(), wanted.end(),
                       [&](std::size_t actuator) { return other.contains(actuator); });
  };
  if (shares(halted())) return "safety";
  for (std::size_t r = 0; r < rules_.size(); ++r) {
    const Rule& other = rules_[r];
    if (r == claim.rule || !other.running || !shares(other.running->actuators)) continue;
    const bool own = other.rank == rule.rank;
    if (other.rank < rule.rank || (own && (other.running->won_now || !claim.trigger)))
      return name_of(other);
    losers.push_back(r);
  }
  return "";
}

void Interpreter::interrupt(std::size_t r, const std::string& by) {
  Rule& rule = rules_[r];
  if (!rule.running->rests) {
    trace_.rule("interrupt", *rule.rule, rule.behavior, std::nullopt, by);
    for (const std::size_t actuator : rule.running->actuators)
      actuators_.cancel(actuator, now_.at);
  }
  rule.running.reset();
  rule.ran = now_.at;
}

// ---- SAFETY

std::set<std::size_t> Interpreter::halted() const {
  std::set<std::size_t> result;
  for (const Guard& guard : guards_)
    if (guard.tripped) result.merge(actuators_of(guard.rule->then_response));
  return result;
}

void Interpreter::interrupt_halted() {
  const std::set<std::size_t> stopped = halted();
  for (std::size_t r = 0; r < rules_.size(); ++r) {
    if (!rules_[r].running) continue;
    const auto& held = rules_[r].running->actuators;
    if (std::any_of(held.begin(), held.end(), [&](std::size_t a) { return stopped.contains(a); }))
      interrupt(r, "safety");
  }
}

// "It trips whenever its condition is true. Unknown is danger", from the first moment on.
void Interpreter::guard(bool all, const std::set<compiler::ChannelRef>& channels) {
  ++guard_now_.step;
  guard_now_.at = now_.at;
  for (Guard& guard : guards_) {
    const bool reads = std::any_of(channels.begin(), channels.end(), [&](const auto& channel) {
      return guard.channels.contains(channel);
    });
    if (all || reads) guard.looked_at = now_.at;
    look_at(guard);
  }
}

void Interpreter::look_at(Guard& guard) {
  const Snapshot readings = inputs_.readings(guard.looked_at, now_.at);
  const Sight sight{readings};
  evaluator_.remember(guard.rule->condition, sight, guard_now_);
  if (guard.rule->resume) evaluator_.remember(*guard.rule->resume, sight, guard_now_);
  const Truth danger = evaluator_.truth(guard.rule->condition, sight);
  if (danger != false) {
    if (!guard.tripped) trip(guard, readings);
    return;
  }
  if (!guard.tripped || !guard.rule->resume) return;
  if (evaluator_.truth(*guard.rule->resume, sight) != true) return;
  const std::set<std::size_t> before = halted();
  guard.tripped = false;
  trace_.rule("resume", *guard.rule, nullptr);
  const std::set<std::size_t> after = halted();
  for (const std::size_t actuator : before)
    if (!after.contains(actuator)) actuators_.release(actuator);
}

void Interpreter::trip(Guard& guard, const Snapshot& readings) {
  trace_.rule("trip", *guard.rule, nullptr);
  const std::set<std::size_t> before = halted();
  guard.tripped = true;
  for (const std::size_t actuator : actuators_of(guard.rule->then_response))
    if (!before.contains(actuator)) actuators_.halt(actuator, now_.at);
  Response response(guard.rule->then_response, rules_.size());
  const Surroundings here{evaluator_, no_chance_, program_.variables, readings, now_.at, false};
  const Output output = response.run(here);
  for (const Effect& effect : output.effects)
    if (const auto* said = std::get_if<Said>(&effect)) say(*said);
  inputs_.stage({output.changes});
}

}  // namespace robosync::oracle
