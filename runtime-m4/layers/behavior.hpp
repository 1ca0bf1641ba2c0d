// Behaviour layer: one thread per behaviour, ranked by priority, without privileges.
//
// Released by the step thread, a behaviour copies its inputs from the snapshot into its frame and
// evaluates the conditions of those of its rules that the step concerns; what follows from them is
// up to Triggers and the step thread. It is released again to run a response, from its beginning or
// from where it waits. What comes of that stays in the workspace, from where the step thread takes
// it: what was set to the variables, commands to the control layer, texts to the trace. A
// behaviour's thread writes the workspace and nothing else (behavior_thread.cpp).
#pragma once

#include <array>
#include <cstdint>

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
    Variables& variables;
    ControlLayer& control;
  };
  // Where a response waits.
  struct ResumePoint {
    std::uint32_t wake = vm::Machine::kNever;  // program time; of all waits but THEN
    std::uint16_t next = 0;                    // word of the code section
    vm::Pause pause = vm::Pause::ended;
  };

  BehaviorLayer(kernel::Kernel& kernel, const Neighbours& neighbours)
      : kernel_(kernel), layers_(neighbours), workspace_(neighbours.workspace) {}

  // Starts the threads of `program`, which must stay until they are dismissed.
  [[nodiscard]] bool start(const LoadedProgram& program, ProgramThreads& threads);

  // --- for the step thread; busy() until all released ones have finished. When one has, its thread
  // makes the call `report` ---
  // `rules` must stay until then.
  void evaluate(const RuleSet& rules, const Snapshot& snapshot);
  void respond(unsigned rule, Side side);
  void go_on(unsigned rule);
  bool busy();
  // The response has been run: tells what it has put out, stages its commands, and notes where it
  // waits. Not before, so that the behaviours' stacks can be short.
  void conclude(unsigned rule);
  const ResumePoint& resume_point(unsigned rule) const { return resume_points_[rule]; }
  void forget_resume_point(unsigned rule) { resume_points_[rule] = {}; }
  void retire(unsigned behavior);  // its thread was stopped

  std::uint16_t response_of(unsigned rule, Side side) const;

private:
  static constexpr kernel::Events kEvaluate = 1;
  static constexpr kernel::Events kRespond = 2;

  struct Unit {
    BehaviorLayer* layer = nullptr;
    kernel::Thread* thread = nullptr;
    std::uint8_t behavior = 0;
  };

  [[nodiscard]] bool start_unit(unsigned behavior, ProgramThreads& threads);
  // --- the behaviour's thread: without privileges ---
  void run(Unit& unit);
  void latch(const Unit& unit, vm::Machine& machine);
  void evaluate_rules(const Unit& unit, vm::Machine& machine);
  void judge_rule(unsigned rule, vm::Machine& machine);
  vm::Value evaluate_rule(unsigned rule, vm::Machine& machine);
  void evaluate_period(unsigned rule, vm::Machine& machine);
  void run_response(vm::Machine& machine);

  void put_out(std::span<const vm::Word> output);
  void stage(const vm::Output& said);
  vm::Progress checked_progress() const;
  void release(unsigned rule, std::uint16_t code);
  void release(unsigned behavior, kernel::Events event);

  kernel::Kernel& kernel_;
  Neighbours layers_;
  Workspace& workspace_;
  const LoadedProgram* program_ = nullptr;
  const Snapshot* snapshot_ = nullptr;
  const RuleSet* concerned_ = nullptr;
  BehaviorMask released_ = 0;
  BehaviorMask retired_ = 0;
  // What the behaviour that is released for it runs: the response of which rule, and from where.
  std::uint16_t rule_ = 0;
  std::uint16_t code_ = 0;
  std::array<Unit, kMaxBehaviors> units_{};
  std::array<ResumePoint, kMaxRules> resume_points_{};
};

}  // namespace robosync::layers
