// Evaluates the SAFETY rules of the running program and acts on them immediately, in the safety
// thread: it does not wait for a step.
//
// It reads the latest readings of the sensors, and the variables as of the last step: when one of
// these changes, at each period of program time, and when a time word is due (monitor.hpp). A
// rule trips when its condition is true or unknown, from the beginning of program time on; the runtime begins that
// when the sensors have had time to measure. It stays tripped until its resume condition is true while its
// condition is false; without a resume condition, until the next program. Actuators that it has
// halted take no command meanwhile, nor while another tripped rule halts them.
//
// Its bytecode runs in a sandbox: unprivileged, with one memory region that it may write. An access to anything else
// is a fault of the safety thread: outputs off, reset.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
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
    guard::OutputGuard& outputs;
    layers::Alarm& alarm;
    const layers::ProcessingLayer& processing;  // for the snapshot of its last step
  };

  SafetyRules(kernel::Kernel& kernel, const Neighbours& neighbours, kernel::Thread& step_thread,
              kernel::Events acted)
      : kernel_(kernel), layers_(neighbours), step_thread_(step_thread), acted_(acted) {}

  // Starts with no rule tripped. `program` must stay valid until the next start().
  [[gnu::cold]] void start(const layers::LoadedProgram& program, const layers::SafetyRegion& region,
                           layers::Memory& memory);

  // Evaluates all rules. Returns the time at which a time word of theirs is due.  [safety thread]
  kernel::Time look();

  // Bit r of `bits`, which are 0: rule r is tripped now. Only under Kernel::lock().  [any]
  void fill_tripped_now(std::span<std::uint32_t> bits) const;
  // The rules that have tripped since start(), as their rule_key()s. Returns how many; those that find no room are left out.  [any]
  std::size_t fill_tripped(std::span<std::uint32_t> keys) const;
  // Has one of them a key that is not in `known`?  [any]
  bool have_tripped_besides(std::span<const std::uint32_t> known) const;

private:
  void latch(std::uint32_t tick);
  [[gnu::cold, gnu::noinline]] void latch_fresh();
  [[gnu::noinline]] vm::Value value_of_variable(std::uint8_t input) const;
  const vm::Rule* evaluate(const vm::Rule& rule);
  vm::Value truth_of(const vm::Rule& rule);
  void tell_zero_divide(const vm::Rule& rule);
  // Rare paths are out of line, so that they take no registers from the frequent one.
  [[gnu::cold, gnu::noinline]] void note_zero_divide(const vm::Rule& rule);
  [[gnu::cold, gnu::noinline]] void trip(const vm::Rule& rule);
  void stage_writes();
  [[gnu::cold, gnu::noinline]] void resume(const vm::Rule& rule);
  [[gnu::cold]] std::span<const vm::Word> run_body(const vm::Rule& rule);
  [[gnu::cold]] void act(vm::Output said, layers::ActuatorMask halted);
  layers::ActuatorMask halted_by(const vm::Rule& rule) const;
  unsigned number_of(const vm::Rule& rule) const;
  void note_trip(unsigned number);
  bool has_ever_tripped(unsigned number) const;
  std::span<const vm::Rule> rules() const { return {first_rule_, end_rule_}; }
  kernel::Time next_look();
  const layers::Snapshot& snapshot() const { return layers_.processing.snapshot(); }

  kernel::Kernel& kernel_;
  Neighbours layers_;
  kernel::Thread& step_thread_;
  kernel::Events acted_;  // signalled when a rule has set a variable
  const layers::LoadedProgram* program_ = nullptr;
  std::span<const std::uint8_t> inputs_;  // of the rules
  const vm::Rule* first_rule_ = nullptr;  // includes the resume rules
  const vm::Rule* end_rule_ = nullptr;
  std::size_t channels_ = 0;        // of the image: inputs with lower numbers are channels
  const vm::Word* code_ = nullptr;  // of the image, like responses_
  const vm::Response* responses_ = nullptr;
  layers::RuleSet tripped_;
  port::Sandbox sandbox_;
  layers::SafetyRegion::Work* work_ = nullptr;  // the bytecode may write it, output_ and frame_
  std::span<vm::Word> output_;
  vm::Value* frame_ = nullptr;
  // A bit for each number of a rule: Behavior::rule_count is a byte, and the SAFETY rules come first.
  static constexpr unsigned kBits = 32;
  std::array<std::atomic<std::uint32_t>, 256 / kBits> ever_tripped_{};
};

}  // namespace robosync::safety
