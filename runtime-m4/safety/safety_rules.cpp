// See safety_rules.hpp. May rely on the verifier: SAFETY holds safety rules, each with a resume rule behind it or none, and
// bodies are straight-line code.
#include "runtime-m4/safety/safety_rules.hpp"

#include <algorithm>
#include <utility>

#include "runtime-m4/layers/report.hpp"

namespace robosync::safety {

using layers::ActuatorMask;
using link::EventKind;

namespace {

ActuatorMask actuators_of(const vm::Image& image, std::uint8_t target) {
  return target == vm::kAllActuators ? ~ActuatorMask{0} : image.target_mask(target);
}

}  // namespace

void SafetyRules::start(const layers::LoadedProgram& program, layers::Memory& memory) {
  program_ = &program;
  tripped_.start(memory.take<policy::Part::tripped, layers::RuleSet::Word>());
  output_ = memory.take<policy::Part::safety_output, vm::Word>();
  have_tripped_ = false;
  inputs_ = {};
  first_rule_ = end_rule_ = nullptr;
  const vm::Image& image = program.image;
  const bool are_there = image.has_safety();
  layers_.alarm.watch(are_there ? program.inputs[vm::kSafetyBehavior] : 0);
  if (!are_there) return;
  const vm::Behavior& safety = image.behaviors[vm::kSafetyBehavior];
  machine_ = layers_.frames.machine(program, vm::kSafetyBehavior);
  inputs_ = image.inputs.subspan(safety.first_input, safety.input_count);
  channels_ = image.channels.size();
  code_ = image.code.data();
  responses_ = image.responses.data();
  first_rule_ = image.rules.data() + safety.first_rule;
  end_rule_ = first_rule_ + safety.rule_count;
}

kernel::Time SafetyRules::look(kernel::Time now) {
  if (first_rule_ == nullptr) return kernel::kForever;
  latch(now);
  machine_.now = layers_.trace.milliseconds();
  const vm::Rule* rule = first_rule_;
  do {
    rule = evaluate(*rule, now);
  } while (rule != end_rule_);
  return next_look(now);
}

inline void SafetyRules::latch(kernel::Time now) {
  const layers::Mailboxes& mailboxes = layers_.mailboxes;
  if (!mailboxes.are_fresh(now)) [[unlikely]]
    return latch_fresh(now);
  layers::Frames::latch(machine_, inputs_, [&](std::uint8_t input) {
    return input < channels_ ? mailboxes.value(input) : value_of_variable(input);
  });
}

vm::Value SafetyRules::value_of_variable(std::uint8_t input) const {
  return snapshot().value(input);
}

void SafetyRules::latch_fresh(kernel::Time now) {
  layers::Frames::latch(machine_, inputs_, [&](std::uint8_t input) {
    if (input >= channels_) return value_of_variable(input);
    return layers_.mailboxes.fresh_value(input, program_->image.channels[input], now);
  });
}

// Where it trips, the pins come first and all else behind them. The resume condition is evaluated in any case: it may
// have to remember something. Returns the next rule, behind that condition.
[[gnu::always_inline]] inline const vm::Rule* SafetyRules::evaluate(const vm::Rule& rule,
                                                                    kernel::Time now) {
  const vm::Value danger = truth_of(rule);
  const bool was_tripped = !tripped_.empty() && tripped_.has(number_of(rule));
  const bool trips = !was_tripped && danger != vm::kFalse;
  if (trips) layers_.outputs.halt(halted_by(rule), now);
  tell_zero_divide(rule);
  const vm::Rule* next = &rule + 1;
  vm::Value safe_again = vm::kFalse;
  if (next != end_rule_ && next->kind == vm::RuleKind::resume) {
    safe_again = truth_of(*next);
    tell_zero_divide(*next);
    ++next;
  }
  if (trips) trip(rule);
  if (was_tripped && danger == vm::kFalse && safe_again == vm::kTrue) resume(rule);
  return next;
}

inline vm::Value SafetyRules::truth_of(const vm::Rule& rule) {
  return vm::evaluate(machine_, code_ + rule.condition_start);
}

inline void SafetyRules::tell_zero_divide(const vm::Rule& rule) {
  if (machine_.divided_by_zero) [[unlikely]]
    note_zero_divide(rule);
}

void SafetyRules::note_zero_divide(const vm::Rule& rule) {
  machine_.divided_by_zero = false;
  layers_.trace.emit(EventKind::zero_divide, layers_.trace.now(), number_of(rule));
}

void SafetyRules::trip(const vm::Rule& rule) {
  const unsigned number = number_of(rule);
  tripped_.insert(number);
  have_tripped_.store(true, std::memory_order_relaxed);
  layers_.trace.emit(EventKind::trip, layers_.trace.now(), number);
  machine_.output = output_.data();
  machine_.output_end = output_.data() + output_.size();
  machine_.shifted = 0;
  machine_.assigned = 0;
  (void)vm::respond(machine_, code_ + responses_[rule.then_response].start);
  const std::span<const vm::Word> output = output_;
  vm::OutputReader reader(output.first(static_cast<std::size_t>(machine_.output - output.data())));
  vm::Output said{};
  while (reader.next(said))
    act(said);
  if (machine_.written() == 0) return;
  layers_.variables.stage_first(
      {.frame = machine_.frame, .assigned = machine_.assigned, .shifted = machine_.shifted},
      program_->image.behaviors[vm::kSafetyBehavior], snapshot());
  kernel_.signal(step_thread_, acted_);
}

void SafetyRules::act(const vm::Output& said) {
  if (said.kind == vm::OutputKind::halt) {
    layers_.control.halt(actuators_of(program_->image, said.target));
  } else if (said.kind != vm::OutputKind::command) {
    layers::report_text(layers_.trace, said, layers_.trace.now());
  }
}

void SafetyRules::resume(const vm::Rule& rule) {
  const unsigned number = number_of(rule);
  tripped_.erase(number);
  layers_.trace.emit(EventKind::resume, layers_.trace.now(), number);
  ActuatorMask still = 0;
  tripped_.each([&](unsigned tripped) { still |= halted_by(program_->image.rules[tripped]); });
  layers_.control.let_go(halted_by(rule) & ~still);
}

// What its body halts: it has no other use for actuators, and the verifier has counted them.
inline ActuatorMask SafetyRules::halted_by(const vm::Rule& rule) const {
  return responses_[rule.then_response].actuators;
}

// As the image counts them.
inline unsigned SafetyRules::number_of(const vm::Rule& rule) const {
  return static_cast<unsigned>(&rule - program_->image.rules.data());
}

// … and none is due any more, until one says so again.
kernel::Time SafetyRules::next_look(kernel::Time now) {
  const std::uint32_t wake = std::exchange(machine_.wake, vm::Machine::kNever);
  if (wake == vm::Machine::kNever) return kernel::kForever;
  const std::uint32_t delay = std::max<std::uint32_t>(wake - machine_.now, 1);
  return now + kernel::milliseconds(delay);
}

}  // namespace robosync::safety
