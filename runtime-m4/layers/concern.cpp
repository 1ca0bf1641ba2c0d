// See processing.hpp: which rules a step concerns. Only these are evaluated; for all others the
// result would be that of last time:
//
// * What a condition gives depends on its inputs, on the past of its time words and on the time. A
//   time word that changes with time alone says when (Triggers::next_wake()).
// * A time word that was true for one evaluation only is false in the next. That is the next step
//   that stirs its behaviour, and one millisecond later at the latest. A division by zero is told
//   in each of these steps, as long as there is one.
// * An input that only a rule's responses read, or set, concerns it too: it stirs the behaviour,
// and
//   responses that wait for something look again (goes_on()).
// * The first time, all rules of a behaviour are evaluated: there are conditions without inputs,
// and
//   such that are known whatever their inputs are.
#include <bit>

#include "runtime-m4/layers/clock.hpp"
#include "runtime-m4/layers/processing.hpp"

namespace robosync::layers {

// `begins`: behaviours that have something to do without a reading.
void ProcessingLayer::find_concerned(InputMask changed, BehaviorMask begins) {
  concerned_.clear();
  changed_ = changed;
  woken_ = begins;
  layers_.triggers.add_woken(snapshot_.milliseconds(), concerned_);
  for (const unsigned rule : concerned_)
    woken_ |= bit<BehaviorMask>(program_->behavior_of[rule]);
  for (InputMask left = changed; left != 0; left &= left - 1)
    concerned_ |= program_->readers[static_cast<unsigned>(std::countr_zero(left))];
  for (const unsigned rule : layers_.triggers.eventful())
    if (stirred(program_->behavior_of[rule])) concerned_.insert(rule);
  const BehaviorMask all = !port::kTimeFlows && evaluates_all_ ? ~BehaviorMask{0} : untouched_;
  for (BehaviorMask left = all; left != 0; left &= left - 1) {
    const auto behavior = static_cast<unsigned>(std::countr_zero(left));
    if (behavior >= program_->image.behaviors.size()) break;
    if (stirred(behavior)) concern_all(behavior);
  }
}

void ProcessingLayer::concern_all(unsigned behavior) {
  untouched_ &= ~bit<BehaviorMask>(behavior);
  const vm::Behavior& wiring = program_->image.behaviors[behavior];
  for (unsigned r = 0; r < wiring.rule_count; ++r)
    concerned_.insert(wiring.first_rule + r);
}

// Something that it reads has changed, or the time of one of its rules has come.
bool ProcessingLayer::stirred(unsigned behavior) const {
  return has(woken_, behavior) || (program_->inputs[behavior] & changed_) != 0;
}

}  // namespace robosync::layers
