// What a behaviour's thread does (behavior.hpp): without privileges, behind the MPU. It reads the
// program, the snapshot and this layer; it writes its stack and the workspace; it asks the kernel
// by the calls of kernel/calls.def. Anything else would stop it.
//
// May rely on the verifier for every index in the image, and for responses that give up within the
// step's budget and kMaxResponseOutput words.
#include <utility>

#include "runtime-m4/kernel/calls.hpp"
#include "runtime-m4/layers/behavior.hpp"
#include "runtime-m4/layers/clock.hpp"

namespace robosync::layers {

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
  if (!port::kTimeFlows) ++workspace_.evaluations;
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
