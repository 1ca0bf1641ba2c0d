// Behaviour layer: one thread per behaviour, ranked by priority, unprivileged.
//
// The step thread releases a behaviour to take its turn in the step. The behaviour copies its inputs
// from the snapshot into its frame and evaluates the conditions of those of its rules that the step
// concerns. Behaviours take their turns in the order of their priority, so ownership is settled by
// then: a behaviour can mostly see for itself that one of its responses wins, and runs it in the same
// activation. Otherwise it is released again to run a response, from its beginning or from where it
// waits. The results stay in the workspace, from which the step thread passes them on: writes to the
// variables, commands to the control layer, texts to the trace. A behaviour's thread writes nothing
// but the workspace.
#pragma once

#include <cstdint>
#include <span>

#include "runtime-m4/kernel/kernel.hpp"
#include "runtime-m4/layers/arbiter.hpp"
#include "runtime-m4/layers/control.hpp"
#include "runtime-m4/layers/frames.hpp"
#include "runtime-m4/layers/loaded_program.hpp"
#include "runtime-m4/layers/program_threads.hpp"
#include "runtime-m4/layers/trace.hpp"
#include "runtime-m4/layers/triggers.hpp"
#include "runtime-m4/layers/variables.hpp"
#include "runtime-m4/layers/workspace.hpp"
#include "runtime-m4/policy/rules.hpp"
#include "vm/interpreter.hpp"
#include "vm/output.hpp"

namespace robosync::layers {

class BehaviorLayer {
public:
  struct Neighbours {
    Trace& trace;
    Workspace& workspace;
    Frames& frames;
    Triggers& triggers;
    const Arbiter& arbiter;
    Variables& variables;
    ControlLayer& control;
  };
  // Where a response waits.
  struct ResumePoint {
    // In program time. If it waits: when to look, or kNever. Otherwise: when it began, or was interrupted; at first, and if it
    // had waited: so long ago that it may begin again.
    std::uint32_t time = 0U - policy::kLeastPauseMs;
    std::uint16_t next = 0;  // a word of the code section
    vm::Pause pause = vm::Pause::ended;
  };

  BehaviorLayer(kernel::Kernel& kernel, const Neighbours& neighbours)
      : kernel_(kernel), layers_(neighbours), workspace_(neighbours.workspace) {}

  // Starts the threads of `program`, which must stay in place until they are dismissed.
  [[nodiscard, gnu::cold]] bool start(const LoadedProgram& program, Memory& memory,
                                      ProgramThreads& threads);

  // --- for the step thread ---
  void begin_step(const Snapshot& snapshot) { snapshot_ = &snapshot; }
  // Each of these releases a behaviour, one at a time; busy() until it has finished. Its thread then
  // makes the call `rest`.
  // The behaviour's turn: it evaluates those of its rules that are in `rules`.
  void take_turn(unsigned behavior, const RuleSet& rules);
  // … where `rule` is the only one to evaluate, and no other rule of its behaviour runs or wants to. `goes_on`: its
  // response goes on, unless something ends it.
  void take_sole_turn(unsigned rule, bool goes_on);
  void respond(unsigned rule, Side side);
  void go_on(unsigned rule);
  bool busy();
  // Has the released behaviour not made the call `rest` yet? It may have finished all the same.
  [[nodiscard, gnu::cold]] bool is_at_work() const;
  // True if the behaviour saw in its turn that it has one claim, that this claim wins, and that no
  // other response of its runs in this step; it has then run the response. `rules`: those that it evaluated.
  bool sole_claim_of(RuleRange rules, Claim& claim) const;
  // … of this rule, and for which side.
  [[gnu::always_inline]] bool has_begun(unsigned rule, Side& side) const {
    const Result& result = *workspace_.result;
    side = result.side != 0 ? Side::then : Side::otherwise;
    return result.there == Result::kBegan && result.rule == rule &&
           !layers_.triggers.cools(rule, side);
  }
  // Does a response for this side begin without taking anything from anybody?
  [[gnu::always_inline]] bool begins_undisputed(unsigned rule, Side side) const {
    return response_of(rule, side) != vm::kNoIndex && !layers_.arbiter.runs(rule) &&
           layers_.arbiter.is_free(actuators_of(rule, side));
  }
  // All that the response for this side, which there is, can ever use.
  [[gnu::always_inline]] ActuatorMask actuators_of(unsigned rule, Side side) const {
    return program_->image.responses[response_of(rule, side)].actuators;
  }
  // Stages the commands of the response that has run, and passes on its texts, if that is not done yet.
  void put_out(ActuatorMask declared);
  // True if in its sole turn the response that was allowed to go on has done so.
  bool went_on(unsigned rule) const {
    const Result& result = *workspace_.result;
    return goes_on_ && result.there == Result::kWentOn && result.rule == rule;
  }
  // The response has run: passes on what it put out, stages its commands, and notes where it waits.
  // Not done earlier, to keep the behaviours' stacks small.
  void conclude(unsigned rule);
  const ResumePoint& resume_point(unsigned rule) const { return resume_points_[rule]; }
  void interrupted(unsigned rule) { resume_points_[rule] = {.time = snapshot_->milliseconds()}; }
  [[gnu::cold]] void retire(unsigned behavior);  // its thread was stopped
  bool is_retired(unsigned behavior) const { return retired_ != 0 && has(retired_, behavior); }
  // The rule's response began in this millisecond, or went on and waits again: it must not do either
  // again in this millisecond. A response that went on to its end may begin again. One that checked its condition and
  // still waits checks it again at each reading, even at a second one in this millisecond.
  bool has_run(unsigned rule, std::uint32_t now) const { return ran_at(rule) == now; }
  // In how many milliseconds it may begin again without a new trigger, or go on after a WAIT UNTIL.
  std::uint8_t rest_left(unsigned rule, std::uint32_t now) const {
    static_assert(policy::kLeastPauseMs <= UINT8_MAX);
    const std::uint32_t passed = now - ran_at(rule);
    const bool has_rested = passed >= policy::kLeastPauseMs;
    return static_cast<std::uint8_t>(has_rested ? 0 : policy::kLeastPauseMs - passed);
  }

  // The thread of a behaviour that blocks in the middle of its task, while `step_thread` waits for it; null if none does.
  // Its memory must be damaged, and nothing would ever wake either thread.  [the safety thread]
  [[nodiscard, gnu::cold]] kernel::Thread* blocked_at_work(const kernel::Thread& step_thread) const;

  // --- for the step thread and the behaviour itself ---
  // The claim of `rule` when it has rested.
  [[nodiscard]] bool will_claim(unsigned rule, Claim& claim) const;
  // The claim of `rule` now, if it has one. silent: the trace has already been told of it.
  [[nodiscard]] bool claim_of(unsigned rule, Claim& claim, bool& silent) const;
  [[nodiscard]] bool claim_for(unsigned rule, Side side, bool retries, Claim& claim) const;
  // A WHILE whose response has begun in this millisecond claims again in the next one. Not inlined: the behaviours' stacks
  // are small.
  [[nodiscard, gnu::noinline]] bool must_pause(unsigned rule) const {
    return layers_.triggers.is_while(rule) && has_run(rule, snapshot_->milliseconds());
  }

private:
  static constexpr kernel::Events kReleased = 1;
  enum class Task : std::uint8_t { turn, sole_turn, response };

  struct Unit {
    BehaviorLayer* layer = nullptr;
    kernel::Thread* thread = nullptr;
    std::uint8_t behavior = 0;
  };

  [[nodiscard, gnu::cold]] bool start_unit(unsigned behavior, ProgramThreads& threads);
  [[gnu::always_inline]] std::uint16_t response_of(unsigned rule, Side side) const {
    const vm::Rule& wiring = program_->image.rules[rule];
    return side == Side::then ? wiring.then_response : wiring.else_response;
  }
  unsigned begin_of(unsigned rule, Side side) const {
    return program_->image.responses[response_of(rule, side)].start;
  }
  // --- the behaviour's thread: unprivileged ---
  void run(Unit& unit);
  void do_task(const Unit& unit, vm::Machine& machine);
  void latch(const Unit& unit, vm::Machine& machine);
  void evaluate_rules(const Unit& unit, vm::Machine& machine);
  void judge_rule(unsigned rule, vm::Machine& machine);
  vm::Value evaluate_rule(unsigned rule, vm::Machine& machine);
  void evaluate_period(unsigned rule, vm::Machine& machine);
  void run_sole_turn(unsigned rule, vm::Machine& machine);
  bool surely_begins(unsigned rule, Side side) const;
  bool sole_claim(RuleRange rules, Claim& claim) const;
  bool waits(RuleRange rules) const;
  void begin_response(vm::Machine& machine, const Claim& claim);
  void run_response(vm::Machine& machine, unsigned rule, Side side, unsigned code);

  void stage(vm::Output said, ActuatorMask declared);
  void stage_writes(unsigned behavior);
  vm::Pause checked_pause(const Result& result) const;
  std::uint32_t ran_at(unsigned rule) const;
  std::uint32_t time_of(unsigned rule, vm::Pause pause, bool has_waited);
  void release(unsigned behavior);
  void release_to_run(unsigned rule, unsigned code);

  kernel::Kernel& kernel_;
  Neighbours layers_;
  Workspace& workspace_;
  const LoadedProgram* program_ = nullptr;
  const Snapshot* snapshot_ = nullptr;
  const RuleSet* concerned_ = nullptr;
  BehaviorMask retired_ = 0;
  // The released behaviour and its task; for a rule, which one, and the code its response begins at or resumes from.
  std::uint8_t released_ = 0;
  bool is_released_ = false;
  Task task_ = Task::turn;
  bool goes_on_ = false;  // for a sole turn
  std::uint16_t rule_ = 0;
  std::uint16_t code_ = 0;
  Command command_{};  // that is being put out; here, so that no parameters need to be cleared
  std::span<Unit> units_;
  std::span<ResumePoint> resume_points_;
  std::span<std::uint32_t> polls_since_;  // by rule; empty if none polls
};

}  // namespace robosync::layers
