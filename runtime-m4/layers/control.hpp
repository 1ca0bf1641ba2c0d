// Control layer: one thread per actuator, which alone drives it.
//
// The step thread stages the commands of a step as responses end. It cancels what was interrupted
// and waits until that is done, then commits everything that was staged in one go. An actuator
// carries out one command at a time and the rest of its queue (kMaxQueued) in order. The robot's limits
// are applied here, whatever the program says.
//
// STOP is a command that does not wait: the commands before it in the queue are dropped, and what the
// actuator is doing ends. It needs no place in the queue. A follow does not wait for a follow: it replaces
// it, queued or under way, and nothing counts as done or cancelled.
//
// Halting (safety) puts actuators into their `safe` state from the caller's thread and refuses all
// commands to them from then on, until they are let go or the next program comes. A person's stop halts
// all of them, whatever program runs or comes, until the person lets them go. The output guard is told of both, so
// that nothing a driver still does reaches a pin.
#pragma once

#include <atomic>
#include <cstdint>
#include <span>

#include "runtime-m4/drivers/drivers.hpp"
#include "runtime-m4/guard/output_guard.hpp"
#include "runtime-m4/kernel/kernel.hpp"
#include "runtime-m4/layers/command_pool.hpp"
#include "runtime-m4/layers/loaded_program.hpp"
#include "runtime-m4/layers/performance.hpp"
#include "runtime-m4/layers/program_threads.hpp"
#include "runtime-m4/layers/trace.hpp"

namespace robosync::layers {

class ControlLayer {
public:
  // Signals to the step thread.
  struct StepEvents {
    kernel::Events idle;       // an actuator has done all its commands
    kernel::Events cancelled;  // an actuator was cancelled
    kernel::Events halted;     // actuators were halted, or let go
  };

  ControlLayer(kernel::Kernel& kernel, guard::OutputGuard& outputs, Trace& trace,
               kernel::Thread& step_thread, StepEvents events)
      : kernel_(kernel),
        outputs_(outputs),
        trace_(trace),
        step_thread_(step_thread),
        events_(events) {}

  // Starts the threads of `program`, which must stay in place until they are dismissed.
  [[nodiscard]] bool start(const LoadedProgram& program, Memory& memory, ProgramThreads& threads);
  // Releases all actuators of a program whose threads are dismissed, and forgets their positions:
  // a program's behaviour must not depend on the one before it.
  void release_all();
  // No program follows: all outputs go off.
  void switch_off();

  // --- for the step thread ---
  // Stages it for each of `actuators`, or drops it where there is no room.
  void stage(const Command& command, ActuatorMask actuators);
  ActuatorMask take_staged();   // those that commands were staged for since the last call
  ActuatorMask take_dropped();  // … and those that dropped one
  // Begins to cancel the one of `actuators` whose thread outranks the others', and returns it. Done when
  // cancelling() is false, which it mostly is immediately.
  ActuatorMask cancel_first(ActuatorMask actuators);
  bool cancelling() const { return cancelling_.load(std::memory_order_relaxed) != 0; }
  void commit() {
    if (to_commit_ != 0) commit_staged();
  }
  ActuatorMask take_idle() { return idle_ == 0 ? 0 : take_all_idle(); }
  [[gnu::always_inline]] ActuatorMask halted() const {
    return halted_.load(std::memory_order_relaxed);
  }
  // … and those that were halted since the last call, even if they have been let go by now.
  ActuatorMask take_halted() {
    return newly_halted_.load(std::memory_order_relaxed) == 0 ? 0 : take_newly_halted();
  }
  // Of some actuators that are or were halted: kSafetyBehavior if the rules have halted one of them; otherwise link::kStop.
  [[gnu::cold]] unsigned halter_of(ActuatorMask halted) const;
  void retire(unsigned actuator);  // its thread was stopped: put it into its safe state

  // [safety thread] An actuator that is already halted, or already free, stays as it is.
  void halt(ActuatorMask actuators);
  void let_go(ActuatorMask actuators);
  // All of them, until the next program.
  void halt_for_good();
  // … and until resume(), in later programs too.
  void stop();
  void resume();

private:
  static constexpr kernel::Events kCommit = 1;
  static constexpr kernel::Events kCancel = 2;
  static constexpr kernel::Events kHalt = 4;
  static constexpr std::uint8_t kNoVerb = 0xFF;

  struct Unit {
    ControlLayer* layer = nullptr;
    kernel::Thread* thread = nullptr;
    drivers::ActuatorState drive;
    Performance performance;
    CommandPool::Queue queue;
    Stamp committed;  // the step that it was handed over in
    std::uint8_t actuator = 0;
    bool busy = false;
    bool follows = false;                // the order under way is a follow
    std::uint8_t staged_stop = kNoVerb;  // the STOP that precedes what is staged
    std::uint8_t stopping = kNoVerb;     // … and the one that precedes what was handed over
  };

  void commit_staged();
  ActuatorMask take_all_idle();
  ActuatorMask take_newly_halted();
  Command* place_of(CommandPool::Queue& queue, bool follows);
  void stage_stop(const Command& command, ActuatorMask actuators);
  void note_staged(ActuatorMask actuators) {
    staged_ |= actuators;
    to_commit_ |= actuators;
  }
  [[nodiscard]] bool start_unit(const vm::Image& image, unsigned actuator, ProgramThreads& threads);
  void take_over(const LoadedProgram& program);
  void run(Unit& unit);
  bool attend(Unit& unit, kernel::Events events, kernel::Time& wake);
  bool goes_elsewhere(const Unit& unit) const;
  kernel::Time work_off(Unit& unit, const Stamp& stamp);
  kernel::Time begin_next(Unit& unit, const Stamp& stamp);
  kernel::Time start_driver(Unit& unit, const Command& command);
  kernel::Time start_performance(Unit& unit, const drivers::Order& order);
  kernel::Time go_on(Unit& unit);
  [[gnu::cold]] kernel::Time give_up(Unit& unit);
  kernel::Time next_key(Unit& unit, kernel::Time now);
  kernel::Time keep_at(Unit& unit, kernel::Time wake, const Stamp& stamp);
  void drop_staged(ActuatorMask actuators);
  bool hand_over(Unit& unit);
  Unit& first_in_rank(ActuatorMask actuators) const;
  void put_at_rest(Unit& unit);
  void note_cancelled(Unit& unit);
  void finish_cancel(Unit& unit);
  bool claim_next(Unit& unit);
  kernel::Time obey_stop(Unit& unit);
  [[gnu::noinline]] kernel::Time stop_driver(Unit& unit);
  void drop_all(Unit& unit);
  [[gnu::noinline]] void tell_stop(const Unit& unit, unsigned verb, const Stamp& stamp);
  [[gnu::noinline]] void tell_command(const Unit& unit, const Command& command, const Stamp& stamp);

  drivers::Device device(Unit& unit);
  const vm::Actuator& wiring(const Unit& unit) const {
    return program_->image.actuators[unit.actuator];
  }
  [[gnu::always_inline]] bool is_halted(const Unit& unit) const {
    return has(halted(), unit.actuator);
  }
  bool rests(const Unit& unit) const {
    return !unit.busy && unit.stopping == kNoVerb && !is_halted(unit);
  }
  // Its queue must wait.
  bool is_held(const Unit& unit) const { return is_halted(unit) || unit.stopping != kNoVerb; }
  ActuatorMask all() const;
  void release(Unit& unit, vm::Release how);
  void hold_back(ActuatorMask fresh);
  void note_halt(ActuatorMask fresh);
  void set_free(ActuatorMask freed);

  kernel::Kernel& kernel_;
  guard::OutputGuard& outputs_;
  Trace& trace_;
  kernel::Thread& step_thread_;
  StepEvents events_;
  const LoadedProgram* program_ = nullptr;
  std::span<Unit> units_;
  CommandPool pool_;
  std::atomic<ActuatorMask> cancelling_ = 0;
  ActuatorMask staged_ = 0;     // since take_staged()
  ActuatorMask to_commit_ = 0;  // since commit()
  ActuatorMask dropped_ = 0;
  ActuatorMask idle_ = 0;
  ActuatorMask retired_ = 0;
  std::atomic<ActuatorMask> halted_ = 0;
  std::atomic<ActuatorMask> newly_halted_ = 0;
  ActuatorMask by_rules_ = 0;  // halted by the program's own rules, or because it hangs
  bool for_good_ = false;      // because it hangs: until the next program
  bool stopped_ = false;       // by a person
  // Of those that are halted or were halted last: those that a person keeps stopped and that no rule halted before. For traces.
  std::atomic<ActuatorMask> by_person_ = 0;
};

}  // namespace robosync::layers
