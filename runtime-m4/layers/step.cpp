// See processing.hpp: what happens in one step, from the changed inputs to the commands.
#include <bit>

#include "runtime-m4/layers/clock.hpp"
#include "runtime-m4/layers/processing.hpp"

namespace robosync::layers {

using link::EventKind;

namespace {

constexpr unsigned kSafety = 0;  // number of the behaviour that holds the safety rules

unsigned lowest(std::uint64_t mask) {
  return static_cast<unsigned>(std::countr_zero(mask));
}

}  // namespace

void ProcessingLayer::step(BehaviorMask released) {
  const std::uint32_t now = snapshot_.milliseconds();
  if (now != ran_at_)
    for (Holding& holding : holdings_)
      holding.has_run = false;
  ran_at_ = now;
  layers_.behaviors.evaluate(released, snapshot_);
  await(kFinished, [this] { return layers_.behaviors.busy(); });
  layers_.triggers.settle(now);
  report_triggers();
  interrupt_over();
  arbitrate();
  cancel_interrupted();
  run_responses(released);
  set_due_ = now + 1;
  layers_.control.commit();
  for (unsigned r = 0; r < rules(); ++r)
    finish_if_done(r);
  // What is due next is looked for as if the step were over.
  for (Holding& holding : holdings_)
    holding.won_now = false;
}

BehaviorMask ProcessingLayer::due_behaviors(InputMask changed) const {
  BehaviorMask due = 0;
  for (unsigned b = program_->first_behavior(); b < program_->image.behaviors.size(); ++b) {
    const std::uint32_t wake = layers_.behaviors.wake(b);
    const bool woken = wake != kNever && reached(wake, snapshot_.milliseconds());
    if (woken || (program_->inputs[b] & changed) != 0) due |= bit<BehaviorMask>(b);
  }
  return due;
}

// --- interruptions that no claim is the cause of ---

void ProcessingLayer::interrupt_lost(BehaviorMask lost) {
  for (unsigned r = 0; lost != 0 && r < rules(); ++r)
    if (holdings_[r].running && has(lost, holdings_[r].behavior))
      interrupt(r, holdings_[r].behavior);
}

void ProcessingLayer::interrupt_halted(ActuatorMask halted) {
  for (unsigned r = 0; halted != 0 && r < rules(); ++r)
    if (holdings_[r].running && (holdings_[r].actuators & halted) != 0) interrupt(r, kSafety);
}

void ProcessingLayer::interrupt_over() {
  for (unsigned r = 0; r < rules(); ++r)
    if (holdings_[r].running && layers_.triggers.is_over(r)) interrupt(r, holdings_[r].behavior);
}

// --- claims ---

void ProcessingLayer::report_triggers() {
  for (unsigned r = 0; r < rules(); ++r)
    if (layers_.triggers.take_zero_divide(r)) trace_.emit(EventKind::zero_divide, trace_.step(), r);
  Side side{};
  for (unsigned r = 0; r < rules(); ++r)
    if (layers_.triggers.fired(r, side))
      trace_.emit(EventKind::fire, trace_.step(), r, 0, static_cast<std::int32_t>(side));
}

// What `rule` claims now; silent: that it does was told before.
bool ProcessingLayer::claim_of(unsigned rule, Claim& claim, bool& silent) const {
  Triggers::Wish wish{};
  if (!layers_.triggers.wish(rule, holdings_[rule].running, wish)) return false;
  silent = wish.silent;
  const std::uint16_t response = layers_.behaviors.response_of(rule, wish.side);
  claim = {.rule = static_cast<std::uint8_t>(rule),
           .behavior = program_->behavior_of[rule],
           .side = wish.side,
           .actuators = program_->image.responses[response].actuators,
           .restarting = layers_.triggers.restarting(rule),
           .retries = !wish.fresh};
  return true;
}

void ProcessingLayer::arbitrate() {
  const std::uint32_t now = snapshot_.milliseconds();
  Claim claim{};
  bool silent = false;
  for (unsigned r = 0; r < rules(); ++r) {
    const bool again = program_->image.rules[r].kind == vm::RuleKind::while_ && has_run(r, now);
    if (!again && claim_of(r, claim, silent)) serve(claim, silent);
  }
  layers_.triggers.forget_all();
}

void ProcessingLayer::serve(const Claim& claim, bool silent) {
  const Decision decision = decide(claim, holdings(), layers_.control.halted());
  const bool was_running = holdings_[claim.rule].running;
  for (RuleMask left = decision.interrupted; left != 0; left &= left - 1)
    interrupt(lowest(left), claim.behavior);
  if (!decision.wins) {
    if (!silent) report(claim, EventKind::lose, decision.owner);
    const bool to_itself = was_running && holdings_[claim.rule].running;
    layers_.triggers.lost(claim.rule, claim.side, to_itself, snapshot_.milliseconds());
    return;
  }
  report(claim, EventKind::win);
  layers_.triggers.won(claim.rule, snapshot_.milliseconds());
  holdings_[claim.rule] = {.actuators = claim.actuators,
                           .pending = 0,
                           .behavior = claim.behavior,
                           .side = claim.side,
                           .running = true,
                           .won_now = true};
}

void ProcessingLayer::interrupt(unsigned rule, unsigned by) {
  Holding& holding = holdings_[rule];
  trace_.emit(EventKind::interrupt, trace_.step(), rule, by);
  cancelled_ |= holding.actuators;
  holding.running = false;
  layers_.behaviors.forget_place(rule);
  layers_.triggers.interrupted(rule);
}

void ProcessingLayer::report(const Claim& claim, EventKind kind, unsigned object) {
  trace_.emit(kind, trace_.step(), claim.rule, object, static_cast<std::int32_t>(claim.side));
}

// --- responses ---

bool ProcessingLayer::goes_on(unsigned rule, BehaviorMask released) const {
  const Holding& holding = holdings_[rule];
  const BehaviorLayer::Place& place = layers_.behaviors.place(rule);
  const std::uint32_t now = snapshot_.milliseconds();
  if (!holding.running || place.pause == vm::Pause::ended || has_run(rule, now)) return false;
  const bool due = place.wake != kNever && reached(place.wake, now);
  switch (place.pause) {
    case vm::Pause::until_done:
      return due && holding.pending == 0;
    case vm::Pause::polling:
    case vm::Pause::still_polling:
      return due || has(released, holding.behavior);
    default:
      return due;
  }
}

void ProcessingLayer::run_responses(BehaviorMask released) {
  for (unsigned r = 0; r < rules(); ++r) {
    if (holdings_[r].running && holdings_[r].won_now) {
      layers_.behaviors.respond(r, holdings_[r].side);
    } else if (goes_on(r, released)) {
      layers_.behaviors.go_on(r);
    } else {
      continue;
    }
    await(kFinished, [this] { return layers_.behaviors.busy(); });
    layers_.behaviors.conclude(r);
    holdings_[r].has_run = true;
    holdings_[r].pending |= layers_.control.take_staged();
    for (ActuatorMask dropped = layers_.control.take_dropped(); dropped != 0;
         dropped &= dropped - 1)
      trace_.emit(EventKind::overrun, trace_.step(), lowest(dropped));
  }
}

// The old ones end before the new ones begin, and before those send commands: what the old ones had
// in their queues takes no place from them.
void ProcessingLayer::cancel_interrupted() {
  if (cancelled_ == 0) return;
  layers_.control.cancel(cancelled_);
  await(kCancelled, [this] { return layers_.control.cancelling(); });
}

}  // namespace robosync::layers
