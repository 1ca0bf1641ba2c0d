#include "tests/timing/firmware/robot.hpp"

#include "bench/firmware/mark.hpp"

namespace robosync::timing {
namespace {

// Each marker stands once, so none of these may be inlined.
[[gnu::noinline]] vm::Value count_condition(vm::Machine& machine, const vm::Word* code) {
  BENCH_MARK(condition_begin);
  const vm::Value result = vm::evaluate(machine, code);
  BENCH_MARK(condition_end);
  return result;
}

[[gnu::noinline]] vm::Progress count_response(vm::Machine& machine, const vm::Word* code) {
  BENCH_MARK(response_begin);
  const vm::Progress progress = vm::respond(machine, code);
  BENCH_MARK(response_end);
  return progress;
}

[[gnu::noinline]] void mark_step() {
  BENCH_MARK(step);
}
[[gnu::noinline]] void mark_rule() {
  BENCH_MARK(rule);
}
[[gnu::noinline]] void mark_then() {
  BENCH_MARK(then);
}
[[gnu::noinline]] void mark_otherwise() {
  BENCH_MARK(otherwise);
}

}  // namespace

void Robot::start(const vm::Image& image) {
  image_ = image;
  cells_.fill(vm::kUnknown);
  timer_memory_.fill(0);
  places_.fill(nullptr);
  inputs_.fill(vm::kUnknown);
  for (std::size_t v = 0; v < image.variables.size(); ++v)
    inputs_[image.channels.size() + v] = image.variables[v].initial;
  for (std::size_t b = 0; b < image.behaviors.size(); ++b) {
    vm::Machine& machine = machines_[b] = {};
    machine.frame = &cells_[b * (vm::kMaxCells + std::size_t{1})];
    machine.constants = image.constants.data();
    machine.timers = image.timers.data();
    machine.timer_memory = timer_memory_.data();
    machine.random = static_cast<std::uint32_t>(b) + 1;
    const vm::Behavior& behavior = image.behaviors[b];
    for (std::size_t r = 0; r < behavior.rule_count; ++r)
      behavior_of_[behavior.first_rule + r] = static_cast<std::uint8_t>(b);
  }
}

void Robot::latch(std::size_t behavior, std::uint32_t now) {
  const vm::Behavior& wiring = image_.behaviors[behavior];
  vm::Machine& machine = machines_[behavior];
  for (std::size_t i = 0; i < wiring.input_count; ++i)
    machine.frame[i] = inputs_[image_.inputs[wiring.first_input + i]];
  machine.now = now;
  machine.wake = vm::Machine::kNever;
}

void Robot::evaluate(std::uint32_t now) {
  mark_step();
  for (std::size_t b = 0; b < image_.behaviors.size(); ++b) {
    const vm::Behavior& behavior = image_.behaviors[b];
    latch(b, now);
    vm::Value* watched = machines_[b].frame + behavior.input_count + behavior.locals;
    for (std::size_t r = 0; r < behavior.rule_count; ++r) {
      const vm::Rule& rule = image_.rules[behavior.first_rule + r];
      if (rule.condition_length == 0) continue;
      const vm::Value truth = count_condition(machines_[b], &image_.code[rule.condition_start]);
      if (rule.kind == vm::RuleKind::watch) *watched++ = truth;
    }
  }
}

bool Robot::has(std::size_t rule, Run run) const {
  if (run == Run::on) return places_[rule] != nullptr;
  const vm::Rule& wiring = image_.rules[rule];
  return (run == Run::then ? wiring.then_response : wiring.else_response) != vm::kNoIndex;
}

void Robot::skip(std::size_t rule) {
  (void)rule;
  mark_rule();
}

void Robot::respond(std::size_t rule, Run run) {
  mark_rule();
  const vm::Rule& wiring = image_.rules[rule];
  const vm::Word* code = places_[rule];
  if (run == Run::then) {
    mark_then();
    code = &image_.code[image_.responses[wiring.then_response].start];
  } else if (run == Run::otherwise) {
    mark_otherwise();
    code = &image_.code[image_.responses[wiring.else_response].start];
  }
  vm::Machine& machine = machines_[behavior_of_[rule]];
  latch(behavior_of_[rule], machine.now);
  machine.output = output_.data();
  machine.output_end = output_.data() + output_.size();
  machine.shifted = 0;
  machine.assigned = 0;
  const vm::Progress progress = count_response(machine, code);
  places_[rule] = progress.pause == vm::Pause::ended ? nullptr : progress.next;
}

}  // namespace robosync::timing
