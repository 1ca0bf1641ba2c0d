// The time words. docs/language.md defines what each one means to a program. With an unknown operand,
// the result is unknown and the state is kept, unless noted otherwise here.
#include "vm/timers.hpp"

#include "vm/arithmetic.hpp"
#include "vm/opcode.hpp"

namespace robosync::vm {
namespace {

// True in this step only: the condition is evaluated again in the next millisecond.
Value happened(Machine& machine) {
  machine.event = true;
  wake_at(machine, machine.now + 1);
  return kTrue;
}

// state: kNotHeld, kHeld, or the time when `b` will have been true for long enough. False and unknown
// restart it.
Value held(Machine& machine, std::uint32_t duration, std::uint32_t& state, Value b) {
  constexpr std::uint32_t kNotHeld = 0;
  constexpr std::uint32_t kHeld = UINT32_MAX;
  if (b != kTrue) {
    state = kNotHeld;
    return b;
  }
  if (state == kNotHeld) {
    const std::uint32_t due = machine.now + duration;
    state = due == kNotHeld || due == kHeld ? 1 : due;  // 2 ms late, once in 49 days
    if (duration == 0) state = kHeld;
  }
  if (state != kHeld && reached(state, machine.now)) state = kHeld;
  if (state == kHeld) return kTrue;
  wake_at(machine, state);
  return kFalse;
}

// Stores in `flag` of `state` whether `truth` is true. Returns whether it is true now and was not
// before. An unknown changes nothing.
bool rises(std::uint32_t& state, std::uint32_t flag, Value truth) {
  if (truth == kUnknown) return false;
  const bool was = (state & flag) != 0;
  state = truth == kTrue ? state | flag : state & ~flag;
  return truth == kTrue && !was;
}

// state[0]: kWasTrue, and the number of stored edges; state[1 …]: their times, the oldest first.
Value counted(Machine& machine, const Timer& timer, std::uint32_t* state, Value b) {
  constexpr std::uint32_t kWasTrue = 1U << 31;
  const auto duration = static_cast<std::uint32_t>(timer.duration);
  if (b == kUnknown) return kUnknown;
  const bool edge = rises(state[0], kWasTrue, b);
  std::uint32_t edges = state[0] & ~kWasTrue;
  if (edges > timer.count) edges = timer.count;
  std::uint32_t gone = 0;
  while (gone < edges && machine.now - state[1 + gone] > duration)
    ++gone;
  edges -= gone;
  for (std::uint32_t i = 0; gone > 0 && i < edges; ++i)
    state[1 + i] = state[1 + i + gone];
  const bool enough = edge && edges + 1 >= timer.count;
  if (enough)
    edges = 0;
  else if (edge)
    state[1 + edges++] = machine.now;
  state[0] = (state[0] & kWasTrue) | edges;
  return enough ? happened(machine) : kFalse;
}

// state[0]: the time of the last edge of `a`; state[1]: the flags. Each operand has its own flag, which
// an unknown keeps. Only an unknown `b` makes the result unknown.
Value sequence(Machine& machine, std::uint32_t duration, std::uint32_t* state, Value a, Value b) {
  constexpr std::uint32_t kFirstWasTrue = 1;
  constexpr std::uint32_t kSecondWasTrue = 2;
  constexpr std::uint32_t kBegun = 4;
  std::uint32_t& flags = state[1];
  if (machine.now - state[0] > duration) flags &= ~kBegun;
  const bool completed = rises(flags, kSecondWasTrue, b) && (flags & kBegun) != 0;
  if (completed) flags &= ~kBegun;
  if (rises(flags, kFirstWasTrue, a)) {
    flags |= kBegun;
    state[0] = machine.now;
  }
  if (completed) return happened(machine);
  return b == kUnknown ? kUnknown : kFalse;
}

// state: 1 if it was true.
Value latch(std::uint32_t& state, Value enter, Value stay) {
  const Value result = enter | (truth(state != 0) & stay);
  if (result != kUnknown) state = result == kTrue ? 1 : 0;
  return result;
}

// state: the last known truth.
Value rose(Machine& machine, std::uint32_t& state, Value b) {
  constexpr std::uint32_t kWasFalse = 1;
  constexpr std::uint32_t kWasTrue = 2;
  if (b == kUnknown) return kUnknown;
  const bool was_false = state == kWasFalse;
  state = b == kTrue ? kWasTrue : kWasFalse;
  return b == kTrue && was_false ? happened(machine) : kFalse;
}

// state: the reference value, encoded so that 0 means none (unknown).
Value changed(Machine& machine, Value least, std::uint32_t& state, Value b) {
  constexpr auto kNone = static_cast<std::uint32_t>(kUnknown);
  if (b == kUnknown) return kUnknown;
  const auto value = static_cast<std::uint32_t>(b);
  const auto reference = static_cast<Value>(state ^ kNone);
  const std::uint32_t difference = b > reference ? value - static_cast<std::uint32_t>(reference)
                                                 : static_cast<std::uint32_t>(reference) - value;
  const bool first = reference == kUnknown;
  const bool enough = difference != 0 && difference >= static_cast<std::uint32_t>(least);
  if (first || enough) state = value ^ kNone;
  return enough && !first ? happened(machine) : kFalse;
}

}  // namespace

Value time_word(Machine& machine, Word word) {
  const Timer& timer = machine.timers[operand_c(word)];
  std::uint32_t* const state = machine.timer_memory + timer.state;
  const auto duration = static_cast<std::uint32_t>(timer.duration);
  const Value a = machine.frame[operand_a(word)];
  const Value b = machine.frame[operand_b(word)];
  switch (timer.kind) {
    case TimerKind::held:
      return held(machine, duration, *state, b);
    case TimerKind::counted:
      return counted(machine, timer, state, b);
    case TimerKind::sequence:
      return sequence(machine, duration, state, a, b);
    case TimerKind::latch:
      return latch(*state, a, b);
    case TimerKind::rose:
      return rose(machine, *state, b);
    case TimerKind::changed:
    case TimerKind::count_:
      break;
  }
  return changed(machine, timer.duration, *state, b);
}

}  // namespace robosync::vm
