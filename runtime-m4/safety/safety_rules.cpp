// See safety_rules.hpp. Relies on the verifier: SAFETY contains safety rules, each followed by a resume rule or none, and
// bodies are straight-line code.
#include "runtime-m4/safety/safety_rules.hpp"

#include <algorithm>
#include <utility>

#include "runtime-m4/layers/report.hpp"
#include "runtime-m4/safety/rule_key.hpp"

namespace robosync::safety {

using layers::ActuatorMask;
using link::EventKind;

namespace {

ActuatorMask actuators_of(const vm::Image& image, std::uint8_t target) {
  return target == vm::kAllActuators ? ~ActuatorMask{0} : image.target_mask(target);
}

std::int32_t run_bytecode(void* machine, const void* code, void* progress) {
  return vm::run(*static_cast<vm::Machine*>(machine), static_cast<const vm::Word*>(code),
                 static_cast<vm::Progress*>(progress));
}

}  // namespace

void SafetyRules::start(const layers::LoadedProgram& program, const layers::SafetyRegion& region,
                        layers::Memory& memory) {
  program_ = &program;
  tripped_.start(memory.take<policy::Part::tripped, layers::RuleSet::Word>());
  output_ = region.output;
  work_ = region.work;
  for (auto& word : ever_tripped_)
    word = 0;
  inputs_ = {};
  first_rule_ = end_rule_ = nullptr;
  const vm::Image& image = program.image;
  const bool are_there = image.has_safety();
  layers_.alarm.watch(are_there ? program.inputs[vm::kSafetyBehavior] : 0);
  if (!are_there) return;
  const vm::Behavior& safety = image.behaviors[vm::kSafetyBehavior];
  work_->machine = layers_.frames.machine(program, vm::kSafetyBehavior);
  frame_ = work_->machine.frame;
  sandbox_.set(region.window, region.stack_top, run_bytecode);
  inputs_ = image.inputs.subspan(safety.first_input, safety.input_count);
  channels_ = image.channels.size();
  code_ = image.code.data();
  responses_ = image.responses.data();
  first_rule_ = image.rules.data() + safety.first_rule;
  end_rule_ = first_rule_ + safety.rule_count;
}

kernel::Time SafetyRules::look() {
  if (first_rule_ == nullptr) return kernel::kForever;
  const std::uint32_t tick = kernel_.tick();
  latch(tick);
  work_->machine.now = layers_.trace.milliseconds(tick);
  const vm::Rule* rule = first_rule_;
  do {
    rule = evaluate(*rule);
  } while (rule != end_rule_);
  return next_look();
}

inline void SafetyRules::latch(std::uint32_t tick) {
  const layers::Mailboxes& mailboxes = layers_.mailboxes;
  if (!mailboxes.are_fresh(tick)) [[unlikely]]
    return latch_fresh();
  layers::Frames::latch(frame_, inputs_, [&](std::uint8_t input) {
    return input < channels_ ? mailboxes.value(input) : value_of_variable(input);
  });
}

vm::Value SafetyRules::value_of_variable(std::uint8_t input) const {
  return snapshot().value(input);
}

void SafetyRules::latch_fresh() {
  const kernel::Time now = kernel_.now();
  layers::Frames::latch(frame_, inputs_, [&](std::uint8_t input) {
    if (input >= channels_) return value_of_variable(input);
    return layers_.mailboxes.fresh_value(input, program_->image.channels[input], now);
  });
}

// If the rule trips, the pins come first, then everything else. The resume condition is always evaluated, because its time
// words may keep state. Returns the rule after that condition.
[[gnu::always_inline]] inline const vm::Rule* SafetyRules::evaluate(const vm::Rule& rule) {
  const vm::Value danger = truth_of(rule);
  const bool was_tripped = !tripped_.empty() && tripped_.has(number_of(rule));
  const bool trips = !was_tripped && danger != vm::kFalse;
  if (trips) layers_.outputs.halt(halted_by(rule));
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
  return sandbox_.call(&work_->machine, code_ + rule.condition_start, nullptr);
}

inline void SafetyRules::tell_zero_divide(const vm::Rule& rule) {
  if (work_->machine.divided_by_zero) [[unlikely]]
    note_zero_divide(rule);
}

void SafetyRules::note_zero_divide(const vm::Rule& rule) {
  work_->machine.divided_by_zero = false;
  layers_.trace.emit(EventKind::zero_divide, layers_.trace.now(), number_of(rule));
}

void SafetyRules::trip(const vm::Rule& rule) {
  const unsigned number = number_of(rule);
  tripped_.insert(number);
  note_trip(number);
  layers_.trace.emit(EventKind::trip, layers_.trace.now(), number);
  vm::OutputReader reader(run_body(rule), work_->params);
  vm::Output said{};
  while (reader.next(said))
    act(said, halted_by(rule));
  if (work_->machine.written() != 0) stage_writes();
}

// Not inlined: on the way to the actuators it would be on the stack.
[[gnu::noinline]] void SafetyRules::stage_writes() {
  const vm::Machine& machine = work_->machine;
  layers_.variables.stage_first(
      {.frame = frame_, .assigned = machine.assigned, .shifted = machine.shifted},
      program_->image.behaviors[vm::kSafetyBehavior], snapshot());
  kernel_.signal(step_thread_, acted_);
}

// Only the safety thread writes, so nothing is lost between the load and the store.
void SafetyRules::note_trip(unsigned number) {
  std::atomic<std::uint32_t>& word = ever_tripped_[number / kBits];
  const std::uint32_t bit = std::uint32_t{1} << number % kBits;
  word.store(word.load(std::memory_order_relaxed) | bit, std::memory_order_relaxed);
}

bool SafetyRules::has_ever_tripped(unsigned number) const {
  return (ever_tripped_[number / kBits].load(std::memory_order_relaxed) >> number % kBits & 1) != 0;
}

void SafetyRules::fill_tripped_now(std::span<std::uint32_t> bits) const {
  std::ranges::copy(tripped_.words().first(std::min(tripped_.words().size(), bits.size())),
                    bits.begin());
}

std::size_t SafetyRules::fill_tripped(std::span<std::uint32_t> keys) const {
  std::size_t count = 0;
  for (const vm::Rule& rule : rules())
    if (has_ever_tripped(number_of(rule)) && count < keys.size())
      keys[count++] = rule_key(program_->image, rule);
  return count;
}

bool SafetyRules::have_tripped_besides(std::span<const std::uint32_t> known) const {
  return std::ranges::any_of(rules(), [&](const vm::Rule& rule) {
    return has_ever_tripped(number_of(rule)) &&
           std::ranges::find(known, rule_key(program_->image, rule)) == known.end();
  });
}

// Returns the body's output.
std::span<const vm::Word> SafetyRules::run_body(const vm::Rule& rule) {
  vm::Machine& machine = work_->machine;
  machine.output = output_.data();
  machine.output_end = output_.data() + output_.size();
  machine.shifted = 0;
  machine.assigned = 0;
  (void)sandbox_.call(&machine, code_ + responses_[rule.then_response].start, &work_->progress);
  return layers::SafetyRegion::put_out(output_, machine.output);
}

void SafetyRules::act(vm::Output said, ActuatorMask halted) {
  if (said.kind == vm::OutputKind::halt) {
    layers_.control.halt(actuators_of(program_->image, said.target) & halted);
  } else if (said.kind != vm::OutputKind::command) {
    layers::report_text(layers_.trace, said, work_->params, layers_.trace.now());
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

// The actuators that its body halts: it uses actuators for nothing else, and the verifier has checked their mask.
inline ActuatorMask SafetyRules::halted_by(const vm::Rule& rule) const {
  return responses_[rule.then_response].actuators;
}

// The rule's number in the image.
inline unsigned SafetyRules::number_of(const vm::Rule& rule) const {
  return static_cast<unsigned>(&rule - program_->image.rules.data());
}

// Resets the machine's wake time: no time word is due until one sets it again. The delay counts from the tick at which the rules
// were evaluated.
kernel::Time SafetyRules::next_look() {
  vm::Machine& machine = work_->machine;
  const std::uint32_t wake = std::exchange(machine.wake, vm::Machine::kNever);
  if (wake == vm::Machine::kNever) return kernel::kForever;
  const std::uint32_t delay = std::max<std::uint32_t>(wake - machine.now, 1);
  return layers_.trace.time_after(machine.now, delay);
}

}  // namespace robosync::safety
