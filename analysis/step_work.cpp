// See step_work.hpp.
#include "analysis/step_work.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <limits>

#include "analysis/costs.hpp"
#include "analysis/variable_ranges.hpp"
#include "analysis/walk.hpp"
#include "runtime-m4/policy/concern.hpp"
#include "runtime-m4/policy/rules.hpp"
#include "runtime-m4/policy/threads.hpp"

namespace robosync::analysis {
namespace {

using vm::Opcode;
using vm::RuleKind;

// True for one step only.
bool is_event(Opcode op) {
  return vm::info_of(op).effect == vm::Effect::event;
}

// A condition is true only in a step in which one of its event words is: as `mood IS calm AND button BECOMES pressed`. Conditions
// have no jumps, so one pass tracks which cells are true only then.
bool is_momentary(std::span<const vm::Word> condition) {
  std::array<bool, vm::kMaxCells + 1> cells{};
  for (const vm::Word word : condition) {
    const Opcode op = vm::opcode_of(word);
    bool& a = cells[vm::operand_a(word)];
    const bool b = cells[vm::operand_b(word)];
    const bool c = cells[vm::operand_c(word)];
    switch (op) {
      case Opcode::ret:
        return a;
      case Opcode::and_:
        a = b || c;
        break;
      case Opcode::or_:
        a = b && c;
        break;
      case Opcode::latch:
        a = a && b;
        break;
      case Opcode::move:
      case Opcode::held:
        a = b;
        break;
      default:
        a = is_event(op);
    }
  }
  return false;
}

// There is an actuator that every side of both rules wants.
// The actuators that each of its responses has.
Actuators common_actuators(const vm::Image& image, unsigned r) {
  const vm::Rule& rule = image.rules[r];
  Actuators mask = ~Actuators{0};
  for (const std::uint16_t index : {rule.then_response, rule.else_response})
    if (index != vm::kNoIndex) mask &= image.responses[index].actuators;
  return rule.then_response == vm::kNoIndex ? Actuators{0} : mask;
}

bool common_actuator(const vm::Image& image, unsigned a, unsigned b) {
  return (common_actuators(image, a) & common_actuators(image, b)) != 0;
}

unsigned most_wanted(const std::vector<Actuators>& masks) {
  unsigned best = 0;
  std::ptrdiff_t most = -1;
  for (unsigned a = 0; a < std::numeric_limits<Actuators>::digits; ++a) {
    const auto wanting =
        std::ranges::count_if(masks, [&](Actuators m) { return (m >> a & 1) != 0; });
    if (wanting > most) best = a;
    most = std::max(most, wanting);
  }
  return best;
}

// The worse of two responses of which one runs in a step, part by part.
ResponseWork worst_of(const ResponseWork& a, const ResponseWork& b) {
  ResponseWork both{.other = std::max(a.other, b.other),
                    .by_actuator = a.by_actuator,
                    .sets = a.sets | b.sets,
                    .later_sets = a.later_sets | b.later_sets,
                    .follows = a.follows || b.follows,
                    .polls = a.polls || b.polls,
                    .pauses = a.pauses};
  both.pauses.note(b.pauses);
  for (std::size_t i = 0; i < both.by_actuator.size(); ++i)
    both.by_actuator[i] = std::max(a.by_actuator[i], b.by_actuator[i]);
  return both;
}

}  // namespace

StepWork::StepWork(const vm::Image& image)
    : image_(image), costs_(image.rules.size()), ranges_(ranges_of_inputs(image)) {
  if (!vm::rule_costs(image, costs_)) costs_.assign(costs_.size(), {});  // the image is verified
  behavior_of_.resize(image.rules.size());
  condition_reads_.resize(image.rules.size());
  reads_.resize(image.rules.size());
  sets_.resize(image.rules.size());
  worst_.resize(image.rules.size());
  held_ms_.resize(image.rules.size());
  events_.resize(image.rules.size());
  becomes_.resize(image.rules.size());
  momentary_.resize(image.rules.size());
  divides_.resize(image.rules.size());
  for (unsigned b = 0; b < image.behaviors.size(); ++b) {
    const vm::Behavior& behavior = image.behaviors[b];
    if (image.has_safety() && b == vm::kSafetyBehavior)
      for (const std::uint8_t input :
           image.inputs.subspan(behavior.first_input, behavior.input_count))
        watched_.set(input);
    for (unsigned i = 0; i < behavior.rule_count; ++i) {
      behavior_of_[behavior.first_rule + i] = b;
      load_rule(behavior.first_rule + i, behavior);
    }
  }
}

void StepWork::load_rule(unsigned r, const vm::Behavior& behavior) {
  const vm::Rule& rule = image_.rules[r];
  policy::each_input_of_condition(image_, behavior, rule,
                                  [&](unsigned input) { condition_reads_[r].set(input); });
  policy::each_input_of_rule(image_, behavior, rule, [&](unsigned input) { reads_[r].set(input); });
  const auto code = image_.code.subspan(rule.condition_start, rule.condition_length);
  for (std::size_t i = 0; i < code.size(); ++i) {
    const vm::Word word = code[i];
    const Opcode op = vm::opcode_of(word);
    if (op == Opcode::lasted) note_held(r, lasts_ms(code.first(i), vm::operand_c(word)));
    if (is_event(op)) ++events_[r];
    if (op == Opcode::rose) becomes_[r] = true;
    if (op == Opcode::held)
      note_held(r, static_cast<std::uint32_t>(image_.timers[vm::operand_c(word)].duration));
    if (vm::info_of(op).effect == vm::Effect::division) divides_[r] = true;
  }
  momentary_[r] = is_momentary(code);
  worst_[r] = worst_of(work_of(image_, behavior, rule.then_response, ranges_),
                       work_of(image_, behavior, rule.else_response, ranges_));
  sets_[r] = worst_[r].sets;
}

// Two ends of one FOR are its duration apart; those of several may coincide.
void StepWork::note_held(unsigned rule, std::uint32_t duration_ms) {
  const std::uint32_t before = held_ms_[rule];
  held_ms_[rule] = std::max(before == 0 ? duration_ms : std::min(before, duration_ms) / 2, 1U);
}

// The shortest time until a TIMER has come this far again: there is a RESTART in between. It is the
// constant that the cell was last loaded with; a computed one may be as short as a millisecond.
std::uint32_t StepWork::lasts_ms(std::span<const vm::Word> before, std::uint8_t cell) const {
  for (std::size_t i = before.size(); i > 0; --i) {
    const vm::Word word = before[i - 1];
    if (vm::operand_a(word) != cell) continue;
    if (vm::opcode_of(word) != Opcode::load) break;
    return std::max(policy::milliseconds_of(image_.constants[vm::operand_wide(word)]), 1U);
  }
  return 1;
}

bool StepWork::is_safety(unsigned rule) const {
  return behavior_of_[rule] < policy::first_behavior(image_);
}

Inputs StepWork::with_bands(Inputs changed) const {
  for (const vm::Check& check : image_.checks)
    if (changed.test(check.input)) changed.set(image_.channels.size() + check.variable);
  return changed;
}

Rules StepWork::concerned(const Inputs& changed) const {
  Rules rules;
  for (unsigned r = 0; r < image_.rules.size(); ++r)
    if (!is_safety(r) && (reads_[r] & changed).any()) rules.insert(r);
  return rules;
}

Inputs StepWork::sets(const Rules& rules) const {
  Inputs sets;
  for (const unsigned rule : rules)
    sets |= sets_[rule];
  return sets;
}

Actuators StepWork::actuators(const Rules& rules) const {
  Actuators mask = 0;
  for (const unsigned rule : rules)
    for (const std::uint16_t index :
         {image_.rules[rule].then_response, image_.rules[rule].else_response})
      if (index != vm::kNoIndex) mask |= image_.responses[index].actuators;
  return mask;
}

// --- what a step costs ---

Rules StepWork::stirred(const Rules& rules, const Inputs& changed) const {
  Rules stirred;
  for (const unsigned rule : rules)
    if ((condition_reads_[rule] & changed).any()) stirred.insert(rule);
  return stirred;
}

Instructions StepWork::step(const Rules& rules, const Inputs& changed) const {
  Instructions sum = standing();
  sum += reads_channel(changed) ? costs::kStep : costs::kTimedStep;
  std::set<unsigned> behaviors;
  for (const unsigned rule : rules)
    behaviors.insert(behavior_of_[rule]);
  for (const unsigned b : behaviors) {
    const vm::Behavior& behavior = image_.behaviors[b];
    sum += costs::kBehavior + Instructions{behavior.input_count} * costs::kInput;
    // A word that was true for one step only is evaluated again in the next step that stirs the behaviour.
    for (unsigned r = behavior.first_rule; r < behavior.first_rule + 0U + behavior.rule_count; ++r)
      if (rules.contains(r) || has_events(r)) sum += evaluation(r);
  }
  sum += changed.count() * Instructions{costs::kChanged};
  if ((changed & watched_).any()) sum += look() + trips();
  return sum;
}

Instructions StepWork::evaluation(unsigned rule) const {
  Instructions sum = costs::kRule + costs_[rule].condition;
  if (divides_[rule]) sum += costs::kZeroDivide;
  if (worst_[rule].polls)
    sum += costs::kPoll + (worst_[rule].follows ? output(rule) : costs_[rule].worst_response());
  return sum;
}

Instructions StepWork::firing(unsigned rule) const {
  if (image_.rules[rule].then_response == vm::kNoIndex) return 0;
  return costs::kClaim + costs::kRun + output(rule) + interruptions(rule);
}

Instructions StepWork::going_on(unsigned rule) const {
  return costs::kGoOn + output(rule);
}

// The worst part of its response.
Instructions StepWork::output(unsigned rule) const {
  Instructions sum = costs_[rule].worst_response() + worst_[rule].other;
  for (const Instructions commands : worst_[rule].by_actuator)
    sum += commands;
  return sum;
}

bool StepWork::contend(unsigned a, unsigned b) const {
  return common_actuator(image_, a, b);
}

// Every response that holds an actuator that the rule wants must end; each actuator has one holder.
Instructions StepWork::interruptions(unsigned rule) const {
  const Actuators wanted = actuators({rule});
  unsigned holders = 0;
  Actuators cancelled = 0;
  for (unsigned r = 0; r < image_.rules.size(); ++r) {
    const Actuators held = is_safety(r) ? 0 : actuators({r});
    if ((held & wanted) == 0) continue;
    ++holders;
    cancelled |= held;
  }
  holders = std::min(holders, static_cast<unsigned>(std::popcount(wanted)));
  Instructions sum = Instructions{costs::kInterrupt} * holders;
  for (unsigned a = 0; a < image_.actuators.size(); ++a)
    if ((cancelled >> a & 1) != 0) sum += costs::kCancel + driver_costs(a).release;
  return sum;
}

// The result of the condition: the word before its end.
vm::Word StepWork::last_word(unsigned r) const {
  const vm::Rule& rule = image_.rules[r];
  if (rule.condition_length < 2) return vm::encode(Opcode::end);
  return image_.code[rule.condition_start + rule.condition_length - 2U];
}

bool StepWork::fires_after_event(unsigned rule) const {
  return !momentary_[rule];
}

bool StepWork::alternates(unsigned rule) const {
  const RuleKind kind = image_.rules[rule].kind;
  if (kind != RuleKind::when && kind != RuleKind::while_) return false;
  return events_[rule] == 0 || (events_[rule] == 1 && becomes_[rule] && momentary_[rule]);
}

std::uint32_t StepWork::gap_ms(unsigned r) const {
  if (image_.rules[r].kind != RuleKind::when) return 0;
  if (vm::opcode_of(last_word(r)) != Opcode::held) return 0;
  return policy::milliseconds_of(image_.timers[vm::operand_c(last_word(r))].duration);
}

std::uint32_t StepWork::cooldown_ms(unsigned r) const {
  const vm::Rule& rule = image_.rules[r];
  if (rule.kind != RuleKind::when) return 0;
  return policy::milliseconds_of(policy::modifiers_of(image_, rule).cooldown);
}

// Channels come before variables.
bool StepWork::reads_channel(const Inputs& changed) const {
  for (std::size_t c = 0; c < image_.channels.size(); ++c)
    if (changed.test(c)) return true;
  return false;
}

// What every step pays for what exists, whatever the step is about.
Instructions StepWork::standing() const {
  Instructions sum = running();
  for (unsigned r = 0; r < image_.rules.size(); ++r)
    if (!is_safety(r) && wants_on(r) && may_lose(r)) sum += costs::kWanting;
  for (const vm::Check& check : image_.checks) {
    sum += costs::kCheck;
    if (check.window > 1) sum += Instructions{costs::kSample} * check.window;
  }
  for (const vm::Variable& variable : image_.variables)
    if (variable.fade != 0) sum += costs::kFading;
  return sum;
}

// Responses that run, wait or rest between two rounds: those that need no actuator, and of the others at most as many as there
// are actuators in a set of which each response holds at least one. Any such set will do; this one is built by repeatedly
// taking the actuator that most of the remaining responses want.
Instructions StepWork::running() const {
  unsigned count = 0;
  std::vector<Actuators> left;
  for (unsigned r = 0; r < image_.rules.size(); ++r) {
    if (is_safety(r)) continue;
    for (const std::uint16_t side : {image_.rules[r].then_response, image_.rules[r].else_response})
      if (side != vm::kNoIndex && image_.responses[side].actuators != 0)
        left.push_back(image_.responses[side].actuators);
    if (actuators({r}) == 0 && (pauses(r).any() || goes_round(r))) ++count;
  }
  for (; !left.empty(); ++count) {
    const unsigned most = most_wanted(left);
    std::erase_if(left, [&](Actuators mask) { return (mask >> most & 1) != 0; });
  }
  return Instructions{costs::kRunning} * count;
}

// Something else may hold what the rule wants and not give way: SAFETY, or a rule that ranks no lower.
bool StepWork::may_lose(unsigned rule) const {
  if (image_.has_safety() || image_.rules[rule].modifiers != vm::kNoModifiers) return true;
  for (unsigned r = 0; r < image_.rules.size(); ++r)
    if (r != rule && !policy::may_take(behavior_of_[rule], behavior_of_[r], true) &&
        (actuators({r}) & actuators({rule})) != 0)
      return true;
  return false;
}

// A rule that loses and claims again later.
bool StepWork::wants_on(unsigned r) const {
  return policy::claims_again(image_, image_.rules[r]);
}

Instructions StepWork::look() const {
  if (!image_.has_safety()) return 0;
  const vm::Behavior& behavior = image_.behaviors[vm::kSafetyBehavior];
  Instructions sum = costs::kGuard + Instructions{behavior.input_count} * costs::kInput;
  for (unsigned r = behavior.first_rule; r < behavior.first_rule + 0U + behavior.rule_count; ++r)
    sum += costs::kSafetyRule + costs_[r].condition;
  return sum;
}

Instructions StepWork::trips() const {
  if (!image_.has_safety()) return 0;
  const vm::Behavior& behavior = image_.behaviors[vm::kSafetyBehavior];
  Instructions sum = 0;
  for (unsigned a = 0; a < image_.actuators.size(); ++a)
    sum += costs::kHalt + driver_costs(a).release;
  for (unsigned r = behavior.first_rule; r < behavior.first_rule + 0U + behavior.rule_count; ++r)
    if (image_.rules[r].kind == RuleKind::safety)
      sum += costs::kTrip + costs_[r].worst_response() + worst_[r].other;
  return sum;
}

// --- what is due on its own ---

// As often as the smallest number that the code of an EVERY may give.
std::uint32_t StepWork::every_ms(unsigned r) const {
  const vm::Rule& rule = image_.rules[r];
  const auto code = image_.code.subspan(rule.condition_start, rule.condition_length);
  Interval period;
  for (Walk walk(image_, image_.behaviors[behavior_of_[r]], code, ranges_); walk.next(); walk.run())
    if (vm::info_of(vm::opcode_of(walk.word())).flow == vm::Flow::end)
      period = walk.cells()[vm::operand_a(walk.word())];
  return policy::period_ms(period.low);
}

std::uint32_t StepWork::begins_ms(unsigned r) const {
  if (is_safety(r)) return Pauses::kNever;
  if (image_.rules[r].kind == RuleKind::every) return every_ms(r);
  std::uint32_t least = Pauses::kNever;
  if (wants_on(r) && may_lose(r)) least = policy::kLeastPauseMs;
  if (goes_round(r)) least = std::min(least, pauses(r).round_ms);
  return least;
}

Actuators StepWork::held_while_pausing(unsigned r) const {
  return pauses(r).any() ? common_actuators(image_, r) : 0;
}

}  // namespace robosync::analysis
