// See processing.hpp: what happens in one step, from the changed inputs to the commands.
#include <bit>

#include "runtime-m4/layers/clock.hpp"
#include "runtime-m4/layers/processing.hpp"

namespace robosync::layers {

using link::EventKind;

void ProcessingLayer::step() {
  const std::uint32_t now = snapshot_.milliseconds();
  if (now != ran_at_) has_run_.clear();
  ran_at_ = now;
  layers_.behaviors.evaluate(concerned_, snapshot_);
  await(kFinished, [this] { return layers_.behaviors.busy(); });
  layers_.triggers.collect(concerned_);
  layers_.triggers.settle(now);
  report_triggers();
  interrupt_over();
  arbitrate();
  cancel_interrupted();
  run_responses();
  set_due_ = now + 1;
  layers_.control.commit();
  for (const unsigned rule : running_) {
    finish_if_done(rule);
    holdings_[rule].won_now = false;  // what is due next is looked for as if the step were over
  }
}

// --- interruptions that no claim is the cause of ---

void ProcessingLayer::interrupt_lost(BehaviorMask lost) {
  if (lost == 0) return;
  for (const unsigned rule : running_)
    if (has(lost, holdings_[rule].behavior)) interrupt(rule, holdings_[rule].behavior);
}

void ProcessingLayer::interrupt_halted(ActuatorMask halted) {
  if (halted == 0) return;
  for (const unsigned rule : running_)
    if ((holdings_[rule].actuators & halted) != 0) interrupt(rule, vm::kSafetyBehavior);
}

void ProcessingLayer::interrupt_over() {
  for (const unsigned rule : running_)
    if (layers_.triggers.is_over(rule)) interrupt(rule, holdings_[rule].behavior);
}

// --- claims ---

void ProcessingLayer::report_triggers() {
  for (const unsigned rule : concerned_)
    if (layers_.triggers.take_zero_divide(rule))
      trace_.emit(EventKind::zero_divide, trace_.step(), rule);
  Side side{};
  for (const unsigned rule : concerned_)
    if (layers_.triggers.fired(rule, side)) {
      trace_.emit(EventKind::fire, trace_.step(), rule, 0, static_cast<std::int32_t>(side));
      adaptation_.count(*program_, program_->behavior_of[rule], snapshot_.milliseconds());
    }
}

// What `rule` claims now; silent: that it does was told before.
bool ProcessingLayer::claim_of(unsigned rule, Claim& claim, bool& silent) const {
  Triggers::Wish wish{};
  if (!layers_.triggers.wish(rule, running_.has(rule), wish)) return false;
  silent = wish.silent;
  const std::uint16_t response = layers_.behaviors.response_of(rule, wish.side);
  claim = {.rule = static_cast<std::uint16_t>(rule),
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
  RuleSet wanting = concerned_;
  wanting |= layers_.triggers.active();
  for (const unsigned rule : wanting) {
    const bool again =
        program_->image.rules[rule].kind == vm::RuleKind::while_ && has_run(rule, now);
    if (!again && claim_of(rule, claim, silent)) serve(claim, silent);
  }
  layers_.triggers.forget(concerned_);
}

void ProcessingLayer::serve(const Claim& claim, bool silent) {
  const Decision decision = decide_now(claim);
  const bool was_running = running_.has(claim.rule);
  for (const unsigned rule : decision.interrupted)
    interrupt(rule, claim.behavior);
  if (!decision.wins) {
    if (!silent) report(claim, EventKind::lose, decision.owner);
    const bool to_itself = was_running && running_.has(claim.rule);
    layers_.triggers.lost(claim.rule, claim.side, to_itself, snapshot_.milliseconds());
    return;
  }
  report(claim, EventKind::win);
  layers_.triggers.won(claim.rule, snapshot_.milliseconds());
  running_.insert(claim.rule);
  holdings_[claim.rule] = Holding{.actuators = static_cast<ActuatorBits>(claim.actuators),
                                  .pending = 0,
                                  .behavior = claim.behavior,
                                  .side = claim.side,
                                  .won_now = true};
}

void ProcessingLayer::interrupt(unsigned rule, unsigned by) {
  trace_.emit(EventKind::interrupt, trace_.step(), rule, by);
  cancelled_ |= holdings_[rule].actuators;
  running_.erase(rule);
  layers_.behaviors.forget_place(rule);
  layers_.triggers.interrupted(rule);
}

void ProcessingLayer::report(const Claim& claim, EventKind kind, unsigned object) {
  trace_.emit(kind, trace_.step(), claim.rule, object, static_cast<std::int32_t>(claim.side));
}

// --- responses ---

bool ProcessingLayer::goes_on(unsigned rule) const {
  const Holding& holding = holdings_[rule];
  const BehaviorLayer::Place& place = layers_.behaviors.place(rule);
  const std::uint32_t now = snapshot_.milliseconds();
  if (place.pause == vm::Pause::ended || has_run(rule, now)) return false;
  const bool due = place.wake != kNever && reached(place.wake, now);
  switch (place.pause) {
    case vm::Pause::until_done:
      return due && holding.pending == 0;
    case vm::Pause::polling:
    case vm::Pause::still_polling:
      return due || stirred(holding.behavior);
    default:
      return due;
  }
}

void ProcessingLayer::run_responses() {
  for (const unsigned rule : running_) {
    Holding& holding = holdings_[rule];
    if (holding.won_now) {
      layers_.behaviors.respond(rule, holding.side);
    } else if (goes_on(rule)) {
      layers_.behaviors.go_on(rule);
    } else {
      continue;
    }
    await(kFinished, [this] { return layers_.behaviors.busy(); });
    layers_.behaviors.conclude(rule);
    has_run_.insert(rule);
    holding.pending = static_cast<ActuatorBits>(holding.pending | layers_.control.take_staged());
    for (ActuatorMask dropped = layers_.control.take_dropped(); dropped != 0;
         dropped &= dropped - 1)
      trace_.emit(EventKind::overrun, trace_.step(),
                  static_cast<unsigned>(std::countr_zero(dropped)));
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
