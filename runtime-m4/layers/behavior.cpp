// See behavior.hpp. May rely on the verifier for every index in the image; of what the behaviours'
// threads leave in the workspace it believes nothing.
#include "runtime-m4/layers/behavior.hpp"

#include <algorithm>
#include <bit>
#include <utility>

#include "runtime-m4/kernel/calls.hpp"
#include "runtime-m4/layers/clock.hpp"
#include "runtime-m4/layers/report.hpp"

namespace robosync::layers {

using link::EventKind;

bool BehaviorLayer::start(const LoadedProgram& program, ProgramThreads& threads) {
  program_ = &program;
  snapshot_ = nullptr;
  released_ = 0;
  retired_ = 0;
  resume_points_.fill({});
  for (unsigned b = program.first_behavior(); b < program.image.behaviors.size(); ++b)
    if (!start_unit(b, threads)) return false;
  return true;
}

bool BehaviorLayer::start_unit(unsigned behavior, ProgramThreads& threads) {
  Unit& unit = units_[behavior];
  unit.layer = this;
  unit.behavior = static_cast<std::uint8_t>(behavior);
  const vm::Behavior& wiring = program_->image.behaviors[behavior];
  kernel::ThreadSpec spec;
  spec.name = name_of(program_->image, wiring.name, "rule");
  spec.category = kernel::Category::behavior;
  spec.privileged = false;
  spec.entry = [](void* self) {
    auto& mine = *static_cast<Unit*>(self);
    mine.layer->run(mine);
  };
  spec.argument = &unit;
  unit.thread = threads.start(spec, behavior, kBehaviorStack);
  return unit.thread != nullptr;
}

// --- called from the step thread ---

void BehaviorLayer::evaluate(const RuleSet& rules, const Snapshot& snapshot) {
  snapshot_ = &snapshot;
  concerned_ = &rules;
  BehaviorMask behaviors = 0;
  for (const unsigned rule : rules)
    behaviors |= bit<BehaviorMask>(program_->behavior_of[rule]);
  const auto lock = kernel_.lock();  // all of them are ready before the first one runs
  for (BehaviorMask left = behaviors & ~retired_; left != 0; left &= left - 1)
    release(static_cast<unsigned>(std::countr_zero(left)), kEvaluate);
}

void BehaviorLayer::respond(unsigned rule, Side side) {
  resume_points_[rule] = {};
  release(rule, program_->image.responses[response_of(rule, side)].start);
}

void BehaviorLayer::go_on(unsigned rule) {
  release(rule, resume_points_[rule].next);
}

void BehaviorLayer::release(unsigned rule, std::uint16_t code) {
  rule_ = static_cast<std::uint16_t>(rule);
  code_ = code;
  workspace_.result = {};
  const unsigned behavior = program_->behavior_of[rule];
  if (!has(retired_, behavior)) release(behavior, kRespond);
}

void BehaviorLayer::release(unsigned behavior, kernel::Events event) {
  released_ |= bit<BehaviorMask>(behavior);
  workspace_.finished[behavior] = false;
  kernel_.signal(*units_[behavior].thread, event);
}

bool BehaviorLayer::busy() {
  for (BehaviorMask left = released_; left != 0; left &= left - 1) {
    const auto behavior = static_cast<unsigned>(std::countr_zero(left));
    if (workspace_.finished[behavior]) released_ &= ~bit<BehaviorMask>(behavior);
  }
  return released_ != 0;
}

// A place in the code, or none.
vm::Progress BehaviorLayer::checked_progress() const {
  const Result& result = workspace_.result;
  vm::Progress progress{.pause = result.pause, .next = result.next, .wake = result.wake};
  const std::span<const vm::Word> code = program_->image.code;
  const bool inside = progress.next >= code.data() && progress.next < code.data() + code.size();
  if (progress.pause > vm::Pause::still_polling || !inside) progress.pause = vm::Pause::ended;
  return progress;
}

// Nothing comes of a response whose behaviour was stopped meanwhile.
void BehaviorLayer::conclude(unsigned rule) {
  const unsigned behavior = program_->behavior_of[rule];
  if (has(retired_, behavior)) workspace_.result = {};
  ResumePoint& point = resume_points_[rule];
  const vm::Progress progress = checked_progress();
  const bool waited = point.pause != vm::Pause::ended;
  const bool moved = progress.pause != vm::Pause::still_polling;
  const Stamp stamp = layers_.trace.step();
  if (waited && moved) layers_.trace.emit(EventKind::go_on, stamp, rule);
  if (layers_.triggers.take_zero_divide(rule))
    layers_.trace.emit(EventKind::zero_divide, stamp, rule);
  const std::size_t words =
      std::min<std::size_t>(workspace_.result.words, workspace_.output.size());
  put_out(std::span(workspace_.output).first(words));
  vm::Machine machine = layers_.frames.machine(*program_, behavior);
  machine.assigned = workspace_.result.assigned;
  machine.shifted = workspace_.result.shifted;
  layers_.variables.stage(machine, program_->image.behaviors[behavior], *snapshot_);
  point = {};
  if (progress.pause == vm::Pause::ended) return;
  const bool for_commands = progress.pause == vm::Pause::until_done;
  point = {.wake = for_commands ? snapshot_->milliseconds() + 1 : progress.wake,
           .next = static_cast<std::uint16_t>(progress.next - program_->image.code.data()),
           .pause = progress.pause};
  if (moved) layers_.trace.emit(EventKind::wait, stamp, rule);
}

void BehaviorLayer::put_out(std::span<const vm::Word> output) {
  vm::OutputReader reader(output);
  vm::Output said{};
  while (reader.next(said)) {
    if (said.kind == vm::OutputKind::command) {
      stage(said);
    } else {
      report_text(layers_.trace, said, layers_.trace.step());
    }
  }
}

// A command to a group goes to each member.
void BehaviorLayer::stage(const vm::Output& said) {
  const vm::Image& image = program_->image;
  if (said.verb >= image.verbs.size()) return;
  if (said.word != vm::kNoWord && said.word >= image.words.size()) return;
  Command command;
  command.verb_ = said.verb;
  command.word_ = said.word;
  command.given_ = said.given;
  command.params_ = said.params;
  for (ActuatorMask left = image.target_mask(said.target); left != 0; left &= left - 1) {
    command.actuator_ = static_cast<std::uint8_t>(std::countr_zero(left));
    layers_.control.stage(command);
  }
}

void BehaviorLayer::retire(unsigned behavior) {
  const vm::Behavior& wiring = program_->image.behaviors[behavior];
  for (unsigned r = 0; r < wiring.rule_count; ++r)
    layers_.triggers.retire(wiring.first_rule + r);
  retired_ |= bit<BehaviorMask>(behavior);
  released_ &= ~bit<BehaviorMask>(behavior);
}

std::uint16_t BehaviorLayer::response_of(unsigned rule, Side side) const {
  const vm::Rule& wiring = program_->image.rules[rule];
  return side == Side::then ? wiring.then_response : wiring.else_response;
}

// --- a behaviour's thread: without privileges, behind the MPU ---

// It reads the program, the snapshot and this layer; it writes its stack and the workspace; it asks
// the kernel by the calls of kernel/calls.def. Anything else would stop it. It may rely on the
// verifier for responses that give up within the step's budget and kMaxResponseOutput words.

void BehaviorLayer::run(Unit& unit) {
  vm::Machine machine = layers_.frames.machine(*program_, unit.behavior);
  while (true) {
    const kernel::Events events = kernel::calls::wait(kernel_, kEvaluate | kRespond);
    latch(unit, machine);
    if ((events & kEvaluate) != 0) evaluate_rules(unit, machine);
    if ((events & kRespond) != 0) run_response(machine);
    workspace_.finished[unit.behavior] = true;
    kernel::calls::report(kernel_);
  }
}

void BehaviorLayer::latch(const Unit& unit, vm::Machine& machine) {
  Frames::latch(machine, program_->image, program_->image.behaviors[unit.behavior],
                [this](std::uint8_t input) { return snapshot_->value(input); });
  machine.now = snapshot_->milliseconds();
  machine.wake = kNever;
}

void BehaviorLayer::evaluate_rules(const Unit& unit, vm::Machine& machine) {
  const vm::Behavior& behavior = program_->image.behaviors[unit.behavior];
  const unsigned end = behavior.first_rule + 0U + behavior.rule_count;
  for (unsigned r = concerned_->from(behavior.first_rule); r < end; r = concerned_->from(r + 1))
    judge_rule(r, machine);
}

void BehaviorLayer::judge_rule(unsigned rule, vm::Machine& machine) {
  switch (program_->image.rules[rule].kind) {
    case vm::RuleKind::start:
      return layers_.triggers.begin(rule);
    case vm::RuleKind::every:
      return evaluate_period(rule, machine);
    case vm::RuleKind::watch:
      machine.frame[program_->truth_cell[rule]] = evaluate_rule(rule, machine);
      break;
    default:
      const vm::Value condition = evaluate_rule(rule, machine);
      layers_.triggers.judge(rule, condition, machine.event);
  }
  layers_.triggers.note_past(rule, machine.wake, machine.event);
}

vm::Value BehaviorLayer::evaluate_rule(unsigned rule, vm::Machine& machine) {
  machine.event = false;
  machine.wake = kNever;
  const vm::Value value =
      vm::evaluate(machine, &program_->image.code[program_->image.rules[rule].condition_start]);
  if (std::exchange(machine.divided_by_zero, false)) layers_.triggers.note_zero_divide(rule);
  return value;
}

void BehaviorLayer::evaluate_period(unsigned rule, vm::Machine& machine) {
  if (!layers_.triggers.begin_period(rule, machine.now)) return;
  layers_.triggers.draw_period(rule, evaluate_rule(rule, machine), machine.now);
}

void BehaviorLayer::run_response(vm::Machine& machine) {
  machine.output = workspace_.output.data();
  machine.output_end = workspace_.output.data() + workspace_.output.size();
  machine.shifted = 0;
  machine.assigned = 0;
  const vm::Progress progress = vm::respond(machine, &program_->image.code[code_]);
  workspace_.result = {
      .pause = progress.pause,
      .next = progress.next,
      .wake = progress.wake,
      .assigned = machine.assigned,
      .shifted = machine.shifted,
      .words = static_cast<std::uint16_t>(machine.output - workspace_.output.data())};
  if (std::exchange(machine.divided_by_zero, false)) layers_.triggers.note_zero_divide(rule_);
}

}  // namespace robosync::layers
