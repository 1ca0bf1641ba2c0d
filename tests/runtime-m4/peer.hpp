// The tests' access to the private parts of a Runtime: its peer, a friend class.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>

#include "runtime-m4/runtime.hpp"
#include "vm/interpreter.hpp"

namespace robosync {

struct RuntimePeer {
  // In the next step all rules of a behaviour are evaluated when one of them is concerned, as in
  // its first step, and save_no_work() holds. This must make no difference. SAFETY rules are
  // evaluated by the safety thread, never by a step.
  static void concern_all(Runtime& runtime) {
    const std::size_t count = runtime.image().behaviors.size();
    layers::BehaviorMask all = ~layers::BehaviorMask{0} >> (8 * sizeof all - count);
    if (runtime.image().has_safety()) all &= ~(layers::BehaviorMask{1} << vm::kSafetyBehavior);
    layers::ProcessingLayer& processing = runtime.shared_.processing;
    processing.untouched_ = all;
    processing.untouched_inputs_ = ~layers::InputMask{0};
    save_no_work(runtime);
  }

  // From now on each new reading concerns the rules that read it, whatever its value, and no turn takes the fast path for
  // a single rule. This must make no difference.
  static void save_no_work(Runtime& runtime) { runtime.shared_.processing.saves_no_work_ = true; }

  // The value of an input in the last step.
  static vm::Value value(const Runtime& runtime, std::uint8_t input) {
    return runtime.shared_.processing.snapshot().value(input);
  }
  static const layers::Mailboxes& mailboxes(const Runtime& runtime) { return runtime.mailboxes_; }
  static unsigned activations(const Runtime& runtime) { return runtime.activations_; }
  static bool has_begun(const Runtime& runtime) { return runtime.begun_; }
  static layers::ActuatorMask halted(const Runtime& runtime) { return runtime.control_.halted(); }

  // A behaviour could write it, too: its thread has access to the workspace.
  static layers::Judgement& judgement(Runtime& runtime, unsigned rule) {
    return runtime.shared_.workspace.judgements[rule];
  }
  static std::atomic<bool>& finished(Runtime& runtime) {
    return *runtime.shared_.workspace.finished;
  }
  static layers::Result& result(Runtime& runtime) { return *runtime.shared_.workspace.result; }
};

}  // namespace robosync

namespace robosync::test {

// The linker wraps vm::run. The number of conditions that the VM has evaluated in this process:
std::uint32_t evaluations();
// From now on `lie` changes what each run of a response says of itself, as a damaged thread of a behaviour could; {}: no longer.
void let_responses_lie(std::function<void(vm::Progress&)> lie);

}  // namespace robosync::test
