// See control.hpp. A unit's drive, busy and committed belong to its thread while it runs; its queue
// and the pool are shared and touched under the kernel's lock.
#include "runtime-m4/layers/control.hpp"

#include <bit>
#include <utility>

#include "runtime-m4/layers/limits.hpp"

namespace robosync::layers {

using link::EventKind;

namespace {

// Written by one thread at a time, and read by others at any time.
void change(std::atomic<ActuatorMask>& mask, ActuatorMask more, ActuatorMask less) {
  mask.store((mask.load(std::memory_order_relaxed) | more) & ~less, std::memory_order_relaxed);
}

}  // namespace

bool ControlLayer::start(const LoadedProgram& program, Memory& memory, ProgramThreads& threads) {
  staged_ = 0;
  to_commit_ = 0;
  dropped_ = 0;
  idle_ = 0;
  retired_ = 0;
  cancelling_ = 0;
  units_ = memory.take<policy::Part::control_units, Unit>();
  pool_.start(memory);
  for (unsigned a = 0; a < program.image.actuators.size(); ++a)
    if (!start_unit(program.image, a, threads)) return false;
  take_over(program);
  return true;
}

// A person's stop comes from the safety thread, at any time. Before this block it finds no program, and halts what
// the last one left; after it, it finds all actuators of the new one.
void ControlLayer::take_over(const LoadedProgram& program) {
  {
    const auto lock = kernel_.lock();
    program_ = &program;
    for_good_ = false;
    by_rules_ = 0;
    newly_halted_ = 0;
    halted_ = stopped_ ? all() : 0;
    by_person_ = halted();
    outputs_.begin_with(halted());
  }
  outputs_.own(program.image);
}

bool ControlLayer::start_unit(const vm::Image& image, unsigned actuator, ProgramThreads& threads) {
  Unit& unit = units_[actuator];
  unit.layer = this;
  unit.actuator = static_cast<std::uint8_t>(actuator);
  unit.drive.actuator = unit.actuator;
  unit.drive.acceleration = image.acceleration_of(actuator);
  kernel::ThreadSpec spec;
  spec.name = name_of(image, image.actuators[actuator].name, "actuator");
  spec.category = kernel::Category::control;
  spec.entry = [](void* self) {
    auto& mine = *static_cast<Unit*>(self);
    mine.layer->run(mine);
  };
  spec.argument = &unit;
  unit.thread = threads.start(spec, actuator);
  return unit.thread != nullptr;
}

void ControlLayer::release_all() {
  outputs_.end_measurements();
  if (program_ == nullptr) return;
  for (unsigned a = 0; a < program_->image.actuators.size(); ++a) {
    Unit& unit = units_[a];
    const vm::Actuator& old = wiring(unit);
    if (!is_halted(unit)) release(unit, old.on_release);
    if (unit.busy || unit.queue.handed > 0) trace_.emit(EventKind::cancel, trace_.now(), a);
  }
  program_ = nullptr;
}

void ControlLayer::switch_off() {
  outputs_.disown();
}

// --- staging, cancelling, committing: called from the step thread ---

void ControlLayer::stage(const Command& command, ActuatorMask actuators) {
  if (command.action() == vm::Action::stop) return stage_stop(command, actuators);
  const vm::Actuator* const wiring = program_->image.actuators.data();
  Unit* const units = units_.data();
  const std::uint32_t verb = std::uint32_t{1} << command.verb();
  const bool is_limited = command.action() != vm::Action::perform && has_limits(command.order());
  const bool follows = command.action() == vm::Action::follow;
  ActuatorMask staged = actuators;
  each_bit(actuators, [&](unsigned a) {
    if ((wiring[a].verbs & verb) == 0) {
      staged &= ~bit<ActuatorMask>(a);
      return;
    }
    const auto lock = kernel_.lock();
    Command* const place = place_of(units[a].queue, follows);
    if (place == nullptr) {
      staged &= ~bit<ActuatorMask>(a);
      dropped_ |= bit<ActuatorMask>(a);
      return;
    }
    *place = command;
    if (is_limited) limit(wiring[a], place->order_);
  });
  note_staged(staged);
}

// A follow behind a waiting follow gives that one a new target, and takes no place.
[[gnu::always_inline]] inline Command* ControlLayer::place_of(CommandPool::Queue& queue,
                                                              bool follows) {
  return follows && CommandPool::renews(queue) ? &CommandPool::last(queue) : pool_.push(queue);
}

[[gnu::noinline]] void ControlLayer::stage_stop(const Command& command, ActuatorMask actuators) {
  ActuatorMask staged = 0;
  each_bit(actuators, [&](unsigned a) {
    if (!has(program_->image.actuators[a].verbs, command.verb())) return;
    const auto lock = kernel_.lock();
    pool_.drop_waiting(units_[a].queue);
    units_[a].staged_stop = command.verb();
    staged |= bit<ActuatorMask>(a);
  });
  note_staged(staged);
}

ActuatorMask ControlLayer::take_staged() {
  return std::exchange(staged_, 0);
}

ActuatorMask ControlLayer::take_dropped() {
  return std::exchange(dropped_, 0);
}

// A thread that is blocked has no driver call under way that this could disturb, and it stays blocked while the lock
// is held: so it need not be woken. If a timer of its expires later, it finds nothing to go on with.
ActuatorMask ControlLayer::cancel_first(ActuatorMask actuators) {
  Unit& unit = first_in_rank(actuators);
  const auto mine = bit<ActuatorMask>(unit.actuator);
  if (has(retired_, unit.actuator)) return mine;
  {
    const auto lock = kernel_.lock();
    if (kernel_.is_ready(*unit.thread)) {
      cancelling_ = mine;
      kernel_.signal(*unit.thread, kCancel);
      return mine;
    }
    put_at_rest(unit);
  }
  note_cancelled(unit);
  return mine;
}

// The one of `actuators`, which is not empty, whose thread outranks the others'.
ControlLayer::Unit& ControlLayer::first_in_rank(ActuatorMask actuators) const {
  Unit* first = &units_[static_cast<unsigned>(std::countr_zero(actuators))];
  each_bit(actuators & (actuators - 1), [&](unsigned a) {
    if (units_[a].thread->rank() < first->thread->rank()) first = &units_[a];
  });
  return *first;
}

void ControlLayer::commit_staged() {
  const auto lock = kernel_.lock();
  const ActuatorMask all = std::exchange(to_commit_, 0);
  if ((all & retired_) != 0) [[unlikely]]
    drop_staged(all & retired_);
  const Stamp stamp = trace_.step();
  ActuatorMask handed = 0;
  each_bit(all, [&](unsigned a) {
    Unit& unit = units_[a];
    if (!hand_over(unit)) return;
    unit.committed = stamp;
    handed |= bit<ActuatorMask>(a);
    kernel_.signal(*unit.thread, kCommit);
  });
  idle_ &= ~handed;
}

// For actuators whose threads were stopped.
[[gnu::cold]] void ControlLayer::drop_staged(ActuatorMask actuators) {
  each_bit(actuators, [&](unsigned a) {
    Unit& unit = units_[a];
    pool_.drop_staged(unit.queue);
    unit.staged_stop = kNoVerb;
  });
  idle_ |= actuators;
  kernel_.signal(step_thread_, events_.idle);
}

// Behind what the same response sent in an earlier step; a new owner gets an actuator with an empty queue.
// False: only a waiting follow has a new target.
inline bool ControlLayer::hand_over(Unit& unit) {
  if (unit.staged_stop != kNoVerb) [[unlikely]] {
    unit.stopping = std::exchange(unit.staged_stop, kNoVerb);
  } else if (!unit.queue.has_staged()) {
    return false;
  }
  unit.queue.hand_over();
  return true;
}

ActuatorMask ControlLayer::take_all_idle() {
  const auto lock = kernel_.lock();
  return std::exchange(idle_, 0);
}

ActuatorMask ControlLayer::take_newly_halted() {
  const auto lock = kernel_.lock();
  return newly_halted_.exchange(0, std::memory_order_relaxed);
}

void ControlLayer::retire(unsigned actuator) {
  Unit& unit = units_[actuator];
  outputs_.halt(bit<ActuatorMask>(actuator));
  release(unit, wiring(unit).safe);
  const auto lock = kernel_.lock();
  pool_.drop_handed(unit.queue);
  unit.busy = false;
  retired_ |= bit<ActuatorMask>(actuator);
  idle_ |= bit<ActuatorMask>(actuator);
  cancelling_ &= ~retired_;
  kernel_.signal(step_thread_, events_.idle | events_.cancelled);
}

// --- safety ---

ActuatorMask ControlLayer::all() const {
  return static_cast<ActuatorMask>((std::uint64_t{1} << program_->image.actuators.size()) - 1);
}

void ControlLayer::halt(ActuatorMask actuators) {
  const ActuatorMask fresh = actuators & all() & ~halted();
  by_rules_ |= actuators & all();
  change(by_person_, 0, fresh);
  hold_back(fresh);
}

// After halt_for_good() no rule lets anything go: the program has hung, and may hang again.
void ControlLayer::let_go(ActuatorMask actuators) {
  if (for_good_) return;
  by_rules_ &= ~actuators;
  if (!stopped_) return set_free(actuators & halted());
  change(by_person_, actuators & halted(), 0);
}

void ControlLayer::stop() {
  stopped_ = true;
  if (program_ == nullptr) return outputs_.halt(~ActuatorMask{0});
  change(by_person_, all() & ~halted(), 0);
  hold_back(all() & ~halted());
}

void ControlLayer::resume() {
  stopped_ = false;
  change(by_person_, 0, by_rules_);
  if (program_ != nullptr) set_free(halted() & ~by_rules_);
}

unsigned ControlLayer::halter_of(ActuatorMask halted) const {
  const bool by_rules = (halted & ~by_person_.load(std::memory_order_relaxed)) != 0;
  return by_rules && program_->image.has_safety() ? unsigned{vm::kSafetyBehavior}
                                                  : unsigned{link::kStop};
}

// The pins come first. A driver call under way sees the mask when it returns (keep_at()).
void ControlLayer::hold_back(ActuatorMask fresh) {
  if (fresh == 0) return;
  outputs_.halt(fresh);
  note_halt(fresh);
}

// Puts the drivers into their safe states, and tells the trace. A thread that is not blocked may be in a driver call, and write
// the same state: it does the rest itself, after the call (run()).
void ControlLayer::note_halt(ActuatorMask fresh) {
  {
    const auto lock = kernel_.lock();
    halted_ |= fresh;
    newly_halted_ |= fresh;
  }
  for (ActuatorMask left = fresh; left != 0; left &= left - 1) {
    Unit& unit = units_[static_cast<unsigned>(std::countr_zero(left))];
    if (kernel_.state(*unit.thread) == kernel::Thread::State::blocked)
      release(unit, wiring(unit).safe);
    trace_.emit(EventKind::halt, trace_.now(), unit.actuator);
    kernel_.signal(*unit.thread, kHalt);
  }
  kernel_.signal(step_thread_, events_.halted);
}

void ControlLayer::set_free(ActuatorMask freed) {
  if (freed == 0) return;
  outputs_.let_go(freed & ~retired_);
  {
    const auto lock = kernel_.lock();
    halted_ &= ~freed;
  }
  for (ActuatorMask left = freed; left != 0; left &= left - 1)
    trace_.emit(EventKind::release, trace_.now(), static_cast<unsigned>(std::countr_zero(left)));
  kernel_.signal(step_thread_, events_.halted);
}

void ControlLayer::halt_for_good() {
  if (program_ == nullptr) return;
  for_good_ = true;
  halt(all());
}

// --- the actuator's thread ---

// Sees to what is under way. Returns whether the next command may begin; otherwise `wake` says when to look again. Inline, since
// the stacks are small.
[[gnu::always_inline]] inline bool ControlLayer::attend(Unit& unit, kernel::Events events,
                                                        kernel::Time& wake) {
  const bool was_halted = (events & kHalt) != 0;  // and may have been let go since
  if ((events & kCancel) != 0) {
    finish_cancel(unit);
    wake = kernel::kForever;
    return false;
  }
  if (events == 0 && !unit.busy) {  // cancel_first()
    wake = kernel::kForever;
    return false;
  }
  if (was_halted || is_halted(unit)) {
    drop_all(unit);
    if (was_halted) release(unit, wiring(unit).safe);
    unit.busy = false;
    wake = kernel::kForever;
    return false;
  }
  if ((events & kCommit) != 0) {
    if (unit.stopping != kNoVerb) wake = obey_stop(unit);
    if (goes_elsewhere(unit)) unit.busy = false;
  }
  if (unit.busy && kernel_.now() >= wake) wake = go_on(unit);
  return !unit.busy;
}

void ControlLayer::run(Unit& unit) {
  kernel::Time wake = kernel::kForever;
  while (true) {
    const kernel::Events events = kernel_.wait(kCommit | kCancel | kHalt, wake);
    // In the common case it rests, and gets commands.
    const bool begins = events == kCommit && rests(unit);
    if (!begins && !attend(unit, events, wake)) continue;
    // A command that finds its actuator free belongs to the step that sent it.
    const Stamp stamp = (events & kCommit) != 0 ? unit.committed : trace_.now();
    wake = work_off(unit, stamp);
  }
}

// It follows, and a new target has come.
bool ControlLayer::goes_elsewhere(const Unit& unit) const {
  if (!unit.follows) return false;
  const auto lock = kernel_.lock();
  return unit.queue.handed > 0 && CommandPool::front(unit.queue).action() == vm::Action::follow;
}

// Begins commands until one needs time or none is left. Returns when to wake.
kernel::Time ControlLayer::work_off(Unit& unit, const Stamp& stamp) {
  for (unsigned i = 0; i <= vm::kMaxQueued && claim_next(unit); ++i) {
    const kernel::Time wake = begin_next(unit, stamp);
    if (unit.busy) return wake;
  }
  return kernel::kForever;
}

// Is there a command to begin? If not, the step thread learns that the actuator is idle.
bool ControlLayer::claim_next(Unit& unit) {
  const auto lock = kernel_.lock();
  if (is_held(unit)) return false;
  if (unit.queue.handed > 0) return unit.queue.begun = true;
  idle_ |= bit<ActuatorMask>(unit.actuator);
  kernel_.signal(step_thread_, events_.idle);
  return false;
}

// The trace is told before the driver starts, so that the two are not on the stack together.
kernel::Time ControlLayer::begin_next(Unit& unit, const Stamp& stamp) {
  const Command& command = CommandPool::front(unit.queue);
  if (trace_.listening()) [[unlikely]]
    tell_command(unit, command, stamp);
  unit.follows = command.action() == vm::Action::follow;
  const kernel::Time wake = keep_at(unit, start_driver(unit, command), stamp);
  const auto lock = kernel_.lock();
  pool_.pop(unit.queue);
  return wake;
}

[[gnu::noinline]] kernel::Time ControlLayer::start_driver(Unit& unit, const Command& command) {
  const drivers::Order& order = command.order();
  if (order.action == vm::Action::perform) return start_performance(unit, order);
  unit.performance.end();
  if (!command.complete() || is_halted(unit)) return drivers::kDone;
  return drivers::driver(wiring(unit).driver).start(device(unit), order, kernel_.now());
}

[[gnu::noinline]] kernel::Time ControlLayer::start_performance(Unit& unit,
                                                               const drivers::Order& order) {
  unit.performance.begin(program_->image, unit.actuator, order, kernel_.now());
  return is_halted(unit) ? drivers::kDone : next_key(unit, kernel_.now());
}

kernel::Time ControlLayer::go_on(Unit& unit) {
  const drivers::Driver& driver = drivers::driver(wiring(unit).driver);
  kernel::Time wake = is_halted(unit) ? 0 : driver.advance(device(unit), kernel_.now());
  if (wake == drivers::kBlocked) return give_up(unit);
  if (wake == drivers::kDone && unit.performance.is_on()) wake = next_key(unit, kernel_.now());
  return keep_at(unit, wake, trace_.now());
}

// What waits behind it would begin where it has not come to.
[[gnu::noinline]] kernel::Time ControlLayer::give_up(Unit& unit) {
  if (is_halted(unit)) return keep_at(unit, drivers::kDone, trace_.now());
  unit.performance.end();
  unit.busy = false;
  trace_.emit(EventKind::blocked, trace_.now(), unit.actuator);
  trace_.emit(EventKind::cancel, trace_.now(), unit.actuator);
  const auto lock = kernel_.lock();
  pool_.drop_handed(unit.queue);
  return kernel::kForever;
}

// Continues the MOTION under way: to its next key, or to its end. A driver that has already arrived
// is not called again before the shortest time of a key has passed.
[[gnu::noinline]] kernel::Time ControlLayer::next_key(Unit& unit, kernel::Time now) {
  Performance& performance = unit.performance;
  drivers::Order order;
  if (!performance.is_on()) return drivers::kDone;
  if (performance.next(program_->image, now, order)) {
    limit(wiring(unit), order);
    const kernel::Time wake = drivers::driver(wiring(unit).driver).start(device(unit), order, now);
    return wake == drivers::kDone ? now + kernel::milliseconds(vm::kMinKeyGapMs) : wake;
  }
  performance.end();
  return performance.ends_at() > now ? performance.ends_at() : drivers::kDone;
}

// After every call of the driver. A halt may have come during the call: then what the driver did last is undone.
kernel::Time ControlLayer::keep_at(Unit& unit, kernel::Time wake, const Stamp& stamp) {
  if (is_halted(unit)) {
    release(unit, wiring(unit).safe);
    unit.busy = false;
    return kernel::kForever;
  }
  unit.busy = wake != drivers::kDone;
  if (unit.busy) return wake;
  trace_.emit(EventKind::done, stamp, unit.actuator);
  return kernel::kForever;
}

// A halt may come during the call, as in keep_at(): then the driver would remember a position that the actuator has left.
void ControlLayer::put_at_rest(Unit& unit) {
  if (!is_halted(unit)) release(unit, wiring(unit).on_release);
  if (is_halted(unit)) release(unit, wiring(unit).safe);
  unit.busy = false;
}

void ControlLayer::note_cancelled(Unit& unit) {
  trace_.emit(EventKind::cancel, trace_.step(), unit.actuator);
  const auto lock = kernel_.lock();
  pool_.drop_handed(unit.queue);
  unit.stopping = kNoVerb;
  idle_ &= ~bit<ActuatorMask>(unit.actuator);
}

void ControlLayer::finish_cancel(Unit& unit) {
  put_at_rest(unit);
  note_cancelled(unit);
  const auto lock = kernel_.lock();
  cancelling_ &= ~bit<ActuatorMask>(unit.actuator);
  kernel_.signal(step_thread_, events_.cancelled);
}

// Waiting commands were dropped when the STOP was staged; the one under way ends here.
kernel::Time ControlLayer::obey_stop(Unit& unit) {
  unsigned verb = kNoVerb;
  {
    const auto lock = kernel_.lock();
    verb = std::exchange(unit.stopping, kNoVerb);
  }
  const Stamp stamp = unit.committed;
  if (unit.busy) trace_.emit(EventKind::cancel, stamp, unit.actuator);
  if (trace_.listening()) [[unlikely]]
    tell_stop(unit, verb, stamp);
  unit.follows = false;
  return keep_at(unit, stop_driver(unit), stamp);
}

[[gnu::noinline]] kernel::Time ControlLayer::stop_driver(Unit& unit) {
  unit.performance.end();
  if (is_halted(unit)) return drivers::kDone;
  drivers::Order order;
  order.action = vm::Action::stop;
  return drivers::driver(wiring(unit).driver).start(device(unit), order, kernel_.now());
}

void ControlLayer::drop_all(Unit& unit) {
  const auto lock = kernel_.lock();
  pool_.drop_handed(unit.queue);
  unit.stopping = kNoVerb;
}

// values as below, with no word and no parameters.
void ControlLayer::tell_stop(const Unit& unit, unsigned verb, const Stamp& stamp) {
  link::Event event;
  Trace::begin(event, EventKind::command, stamp, unit.actuator, verb);
  event.values[0] = -1;
  event.values[1] = 0;
  event.value_count = 2;
  trace_.emit(event);
}

// values: the word or -1, the mask of parameters that the program gave, and these parameters, with limits applied.
void ControlLayer::tell_command(const Unit& unit, const Command& command, const Stamp& stamp) {
  link::Event event;
  Trace::begin(event, EventKind::command, stamp, unit.actuator, command.verb());
  event.values[0] = command.word() == vm::kNoWord ? -1 : command.word();
  event.values[1] = command.given();
  event.value_count = 2;
  each_bit(command.given(),
           [&](unsigned p) { event.values[event.value_count++] = command.order().params[p]; });
  trace_.emit(event);
}

drivers::Device ControlLayer::device(Unit& unit) {
  return {outputs_, wiring(unit), unit.drive};
}

void ControlLayer::release(Unit& unit, vm::Release how) {
  drivers::driver(wiring(unit).driver).release(device(unit), how, kernel_.now());
}

}  // namespace robosync::layers
