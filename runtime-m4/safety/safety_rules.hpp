// Evaluates the SAFETY rules of the running program and does what they say at once, in the safety
// thread: it does not wait for a step.
//
// It reads what the sensors measured last and what the last step knew of the variables: when one of
// those changes, at each period of program time, and when a time word is due (monitor.hpp). A
// rule trips when its condition is true or unknown, from the beginning of program time on: the runtime
// lets that begin when the sensors had their time to measure. It stays tripped until its resume condition is true while its
// condition is false; without a resume condition, until the next program. Actuators that it has
// halted take no command meanwhile, nor while another tripped rule halts them.
#pragma once

#include <atomic>
#include <cstdint>
#include <span>

#include "runtime-m4/kernel/kernel.hpp"
#include "runtime-m4/layers/alarm.hpp"
#include "runtime-m4/layers/control.hpp"
#include "runtime-m4/layers/frames.hpp"
#include "runtime-m4/layers/loaded_program.hpp"
#include "runtime-m4/layers/mailbox.hpp"
#include "runtime-m4/layers/processing.hpp"
#include "runtime-m4/layers/trace.hpp"
#include "runtime-m4/layers/variables.hpp"
#include "runtime-m4/safety/period.hpp"
#include "vm/output.hpp"

namespace robosync::safety {

class SafetyRules {
public:
  struct Neighbours {
    layers::Trace& trace;
    layers::Mailboxes& mailboxes;
    layers::Frames& frames;
    layers::Variables& variables;
    layers::ControlLayer& control;
    layers::Alarm& alarm;
    const layers::ProcessingLayer& processing;  // for the snapshot of its last step
  };

  SafetyRules(kernel::Kernel& kernel, const Neighbours& neighbours, kernel::Thread& step_thread,
              kernel::Events acted)
      : kernel_(kernel), layers_(neighbours), step_thread_(step_thread), acted_(acted) {}

  // Nothing is tripped. `program` must stay until the next start().
  void start(const layers::LoadedProgram& program, layers::Memory& memory);

  // Evaluates all rules; it is `now`. Returns when a time word of theirs is due.  [safety thread]
  kernel::Time look(kernel::Time now);

  bool have_tripped() const { return have_tripped_; }  // one of them, since start()  [any]

private:
  void evaluate(unsigned rule, kernel::Time now);
  vm::Value truth_of(unsigned rule);
  // What is not in a hurry takes no registers from what is.
  [[gnu::noinline]] void tell_zero_divide(unsigned rule);
  [[gnu::noinline]] void trip(unsigned rule);
  [[gnu::noinline]] void resume(unsigned rule);
  void act(const vm::Output& said);
  layers::ActuatorMask halted_by(unsigned rule) const;
  kernel::Time next_look(kernel::Time now) const;
  const layers::Snapshot& snapshot() const { return layers_.processing.snapshot(); }
  const vm::Behavior& rules() const { return program_->image.behaviors[vm::kSafetyBehavior]; }

  kernel::Kernel& kernel_;
  Neighbours layers_;
  kernel::Thread& step_thread_;
  kernel::Events acted_;  // signalled when something was set
  const layers::LoadedProgram* program_ = nullptr;
  bool are_there_ = false;
  std::atomic<bool> have_tripped_ = false;
  layers::RuleSet tripped_;
  vm::Machine machine_;
  std::span<vm::Word> output_;
};

}  // namespace robosync::safety
