// See safety_rules.hpp. May rely on the verifier: a resume rule follows its safety rule, and bodies
// are straight-line code.
#include "runtime-m4/safety/safety_rules.hpp"

#include <algorithm>

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
  are_there_ = program.image.has_safety();
  have_tripped_ = false;
  layers_.alarm.watch(are_there_ ? program.inputs[vm::kSafetyBehavior] : 0);
  if (are_there_) machine_ = layers_.frames.machine(program, vm::kSafetyBehavior);
}

kernel::Time SafetyRules::look(kernel::Time now) {
  if (!are_there_) return kernel::kForever;
  const vm::Image& image = program_->image;
  layers::Frames::latch(machine_, image, rules(), [&](std::uint8_t input) {
    if (program_->is_variable(input)) return snapshot().value(input);
    return layers_.mailboxes.fresh_value(input, image.channels[input], now);
  });
  machine_.now = layers_.trace.milliseconds();
  machine_.wake = vm::Machine::kNever;
  for (unsigned r = rules().first_rule; r < rules().first_rule + 0U + rules().rule_count; ++r)
    if (image.rules[r].kind == vm::RuleKind::safety) evaluate(r, now);
  return next_look(now);
}

// Where it trips, the pins come first and all else behind them. The resume condition is evaluated in any case: it may
// have to remember something.
void SafetyRules::evaluate(unsigned rule, kernel::Time now) {
  const vm::Image& image = program_->image;
  const vm::Value danger = truth_of(rule);
  const bool was_tripped = tripped_.has(rule);
  const bool trips = !was_tripped && danger != vm::kFalse;
  if (trips) layers_.control.make_safe(halted_by(rule), now);
  const bool can_resume =
      rule + 1 < image.rules.size() && image.rules[rule + 1].kind == vm::RuleKind::resume;
  const vm::Value safe_again = can_resume ? truth_of(rule + 1) : vm::kFalse;
  if (trips) trip(rule);
  if (was_tripped && danger == vm::kFalse && safe_again == vm::kTrue) resume(rule);
}

vm::Value SafetyRules::truth_of(unsigned rule) {
  const vm::Image& image = program_->image;
  const vm::Value truth = vm::evaluate(machine_, &image.code[image.rules[rule].condition_start]);
  if (machine_.divided_by_zero) [[unlikely]]
    tell_zero_divide(rule);
  return truth;
}

void SafetyRules::tell_zero_divide(unsigned rule) {
  machine_.divided_by_zero = false;
  layers_.trace.emit(EventKind::zero_divide, layers_.trace.now(), rule);
}

void SafetyRules::trip(unsigned rule) {
  tripped_.insert(rule);
  have_tripped_.store(true, std::memory_order_relaxed);
  layers_.trace.emit(EventKind::trip, layers_.trace.now(), rule);
  const vm::Image& image = program_->image;
  machine_.output = output_.data();
  machine_.output_end = output_.data() + output_.size();
  machine_.shifted = 0;
  machine_.assigned = 0;
  (void)vm::respond(machine_, &image.code[image.responses[image.rules[rule].then_response].start]);
  const std::span<const vm::Word> output = output_;
  vm::OutputReader reader(output.first(static_cast<std::size_t>(machine_.output - output.data())));
  vm::Output said{};
  while (reader.next(said))
    act(said);
  if (machine_.written() == 0) return;
  layers_.variables.stage_first(
      {.frame = machine_.frame, .assigned = machine_.assigned, .shifted = machine_.shifted},
      rules(), snapshot());
  kernel_.signal(step_thread_, acted_);
}

void SafetyRules::act(const vm::Output& said) {
  if (said.kind == vm::OutputKind::halt) {
    layers_.control.halt(actuators_of(program_->image, said.target));
  } else if (said.kind != vm::OutputKind::command) {
    layers::report_text(layers_.trace, said, layers_.trace.now());
  }
}

void SafetyRules::resume(unsigned rule) {
  tripped_.erase(rule);
  layers_.trace.emit(EventKind::resume, layers_.trace.now(), rule);
  ActuatorMask still = 0;
  tripped_.each([&](unsigned tripped) { still |= halted_by(tripped); });
  layers_.control.let_go(halted_by(rule) & ~still);
}

// What its body halts: it has no other use for actuators, and the verifier has counted them.
inline ActuatorMask SafetyRules::halted_by(unsigned rule) const {
  const vm::Image& image = program_->image;
  return image.responses[image.rules[rule].then_response].actuators;
}

kernel::Time SafetyRules::next_look(kernel::Time now) const {
  if (machine_.wake == vm::Machine::kNever) return kernel::kForever;
  const std::uint32_t delay = std::max<std::uint32_t>(machine_.wake - machine_.now, 1);
  return now + kernel::milliseconds(delay);
}

}  // namespace robosync::safety
