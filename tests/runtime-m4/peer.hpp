// What tests see and change of a Runtime that nobody else can: its peer, a friend.
#pragma once

#include <cstdint>

#include "runtime-m4/runtime.hpp"

namespace robosync {

struct RuntimePeer {
  // In the next step all rules of a behaviour are evaluated when one of them is concerned, as in
  // its first step, and no turn is taken by one rule alone; which must make no difference. SAFETY rules are looked at by the safety thread,
  // never by a step.
  static void concern_all(Runtime& runtime) {
    auto all = ~layers::BehaviorMask{0};
    if (runtime.image().has_safety()) all &= ~(layers::BehaviorMask{1} << vm::kSafetyBehavior);
    layers::ProcessingLayer& processing = runtime.shared_.processing;
    processing.untouched_ = all;
    processing.untouched_inputs_ = ~layers::InputMask{0};
    processing.takes_whole_turns_ = true;
  }

  // As a behaviour could write it: the workspace is open to its thread.
  static layers::Judgement& judgement(Runtime& runtime, unsigned rule) {
    return runtime.shared_.workspace.judgements[rule];
  }
};

}  // namespace robosync

namespace robosync::test {

// Conditions that the VM has evaluated so far, in this program: vm::run is wrapped by the linker.
std::uint32_t evaluations();

}  // namespace robosync::test
