#include "tests/oracles/bytecode/instruction.hpp"

#include <algorithm>
#include <optional>
#include <stdexcept>
#include <string>

#include "tests/oracles/rsl/values.hpp"
#include "tests/support/operands.hpp"
#include "vm/timers.hpp"

namespace robosync::oracle {
namespace {

using fuzz::kind_of;
using vm::Machine;
using vm::Opcode;
using vm::Operand;
using vm::Value;
using vm::Word;

// A cell or a constant, by what opcodes.def says of the operand.
Value at(const Machine& machine, Word word, std::size_t place) {
  const unsigned index = fuzz::operand(word, place);
  const Operand kind = kind_of(word, place);
  const bool constant =
      vm::widened(kind) == Operand::const8 || vm::widened(kind) == Operand::const16;
  return constant ? machine.constants[index] : machine.frame[index];
}
Number number_at(const Machine& machine, Word word, std::size_t place) {
  return number_of(at(machine, word, place));
}
Truth truth_at(const Machine& machine, Word word, std::size_t place) {
  return truth_of(at(machine, word, place));
}

// The lower 32 bits.
Value wrapped(std::int64_t value) {
  return static_cast<Value>(static_cast<std::uint32_t>(static_cast<std::uint64_t>(value)));
}

std::uint32_t milliseconds(Number duration) {
  return static_cast<std::uint32_t>(std::max<std::int64_t>(duration.value_or(0), 0));
}

// Notes that the result may change at `time`, if nothing is known to change it sooner.
void wakes_at(Machine& machine, std::uint32_t time) {
  if (time == Machine::kNever) time = 0;  // which stands for "never": a millisecond late
  const auto away = [&](std::uint32_t when) { return when - machine.now; };
  if (machine.wake == Machine::kNever || away(time) < away(machine.wake)) machine.wake = time;
}

// ---- what is computed of B and C

std::optional<Number> exact(Machine& machine, Opcode opcode, Number b, Number c) {
  const bool divides = opcode == Opcode::div || opcode == Opcode::mod;
  if (divides && b && c == 0) machine.divided_by_zero = true;
  switch (opcode) {
    case Opcode::add:
    case Opcode::add_k:
      return add(b, c);
    case Opcode::sub:
      return subtract(b, c);
    case Opcode::mul:
      return multiply(b, c);
    case Opcode::div:
      return divide(b, c);
    case Opcode::div_k:  // the constant is no number of thousandths
      return divide(b, *c * vm::kScale);
    case Opcode::mod:
    case Opcode::mod_k:
      return modulo(b, c);
    case Opcode::neg:
      return negate(b);
    case Opcode::abs:
      return absolute(b);
    case Opcode::min:
      return lesser(b, c);
    case Opcode::max:
      return greater(b, c);
    case Opcode::round:
      return to_multiple(b, c);
    case Opcode::min_k:
      return b ? Number(std::min(*b, *c)) : b;
    case Opcode::max_k:
      return b ? Number(std::max(*b, *c)) : b;
    case Opcode::random: {
      Chance chance(machine.random);
      const Number drawn = chance.draw(b, c);
      machine.random = chance.state();
      return drawn;
    }
    default:
      return std::nullopt;
  }
}

// What looks at nothing, not even whether its operands are known.
std::optional<Value> unchecked(Opcode opcode, std::int64_t b, std::int64_t c) {
  switch (opcode) {
    case Opcode::move:
    case Opcode::load:
      return wrapped(b);
    case Opcode::add_fast:
    case Opcode::add_k_fast:
      return wrapped(b + c);
    case Opcode::mul_fast:
      return wrapped(b / vm::kScale * c);
    case Opcode::mul_k_fast:
      return wrapped(b * c);
    default:
      return std::nullopt;
  }
}

std::optional<Truth> relation(Opcode opcode, Number left, Number right) {
  const bool known = left && right;
  const auto holds = [known](bool truth) { return known ? Truth(truth) : std::nullopt; };
  switch (opcode) {
    case Opcode::lt:
    case Opcode::lt_k:
    case Opcode::unless_lt:
    case Opcode::unless_lt_k:
      return holds(left < right);
    case Opcode::le:
    case Opcode::le_k:
    case Opcode::unless_le:
    case Opcode::unless_le_k:
      return holds(left <= right);
    case Opcode::gt_k:
    case Opcode::unless_gt_k:
      return holds(left > right);
    case Opcode::ge_k:
    case Opcode::unless_ge_k:
      return holds(left >= right);
    case Opcode::eq:
    case Opcode::eq_k:
    case Opcode::unless_eq:
    case Opcode::unless_eq_k:
      return holds(left == right);
    case Opcode::ne:
    case Opcode::ne_k:
    case Opcode::unless_ne:
    case Opcode::unless_ne_k:
      return holds(left != right);
    default:
      return std::nullopt;
  }
}

bool is_time_word(Opcode opcode) {
  return opcode == Opcode::held || opcode == Opcode::counted || opcode == Opcode::sequence ||
         opcode == Opcode::latch || opcode == Opcode::rose || opcode == Opcode::changed;
}

// It is `time` now, or later: the clock wraps, and what is less than half of it away is ahead.
Truth has_come(Machine& machine, std::uint32_t time) {
  if (machine.now - time < 0x8000'0000) return true;
  wakes_at(machine, time);
  return false;
}

// How long ago it was; no more than a value can say.
Value elapsed(const Machine& machine, Value begin) {
  const std::uint32_t gone = machine.now - static_cast<std::uint32_t>(begin);
  return gone > 0x7FFF'FFFF ? vm::kValueMax : static_cast<Value>(gone);
}

Truth lasted(Machine& machine, Value begin, Value length) {
  if (length == vm::kUnknown) return std::nullopt;
  const Value gone = elapsed(machine, begin);
  if (length <= gone) return true;
  wakes_at(machine,
           machine.now + static_cast<std::uint32_t>(length) - static_cast<std::uint32_t>(gone));
  return false;
}

std::optional<Truth> logic(Machine& machine, Word word) {
  switch (vm::opcode_of(word)) {
    case Opcode::and_:
      return both(truth_at(machine, word, 1), truth_at(machine, word, 2));
    case Opcode::or_:
      return either(truth_at(machine, word, 1), truth_at(machine, word, 2));
    case Opcode::not_:
      return opposite(truth_at(machine, word, 1));
    case Opcode::lasted:
      return lasted(machine, at(machine, word, 1), at(machine, word, 2));
    case Opcode::reached:
      return has_come(machine, static_cast<std::uint32_t>(at(machine, word, 1)));
    default:
      return relation(vm::opcode_of(word), number_at(machine, word, 1),
                      number_at(machine, word, 2));
  }
}

// What goes into A; nothing where the instruction is of another kind.
std::optional<Value> computed(Machine& machine, Word word) {
  const Opcode opcode = vm::opcode_of(word);
  if (is_time_word(opcode)) return vm::time_word(machine, word);
  const Value b = at(machine, word, 1);
  const Value c = at(machine, word, 2);
  if (opcode == Opcode::now)  // an unknown is no time: then it is the millisecond before
    return static_cast<Value>(machine.now == 0x8000'0000 ? machine.now - 1 : machine.now);
  if (opcode == Opcode::elapsed) return elapsed(machine, b);
  if (const auto value = unchecked(opcode, b, c)) return value;
  if (const auto number = exact(machine, opcode, number_of(b), number_of(c)))
    return value_of(*number);
  if (const auto truth = logic(machine, word)) return value_of(*truth);
  return std::nullopt;
}

// ---- what acts

void put(Machine& machine, std::initializer_list<Word> words) {
  if (machine.output_end - machine.output < static_cast<std::ptrdiff_t>(words.size())) return;
  machine.output = std::copy(words.begin(), words.end(), machine.output);
}

bool acts(Machine& machine, Word word) {
  switch (vm::opcode_of(word)) {
    case Opcode::set:
    case Opcode::shift: {
      const Value value = at(machine, word, 1);
      if (value == vm::kUnknown) return true;
      const unsigned cell = fuzz::operand(word, 0);
      machine.frame[cell] = value;
      const bool assigns = vm::opcode_of(word) == Opcode::set;
      (assigns ? machine.assigned : machine.shifted) |= 1U << cell;
      return true;
    }
    case Opcode::arg:
    case Opcode::arg_k:
      put(machine, {word, static_cast<Word>(at(machine, word, 1))});
      return true;
    case Opcode::cmd:
    case Opcode::cmd_end:
    case Opcode::log:
    case Opcode::alert:
    case Opcode::halt:
      put(machine, {word});
      return true;
    default:
      return false;
  }
}

// ---- where it goes on

Done target_if(bool jumps) {
  return {jumps ? Went::to_target : Went::on};
}
Done paused(vm::Pause why, std::uint32_t wake, bool at_target = false) {
  return {Went::paused, vm::kUnknown, why, wake, at_target};
}

std::optional<Done> counts(Machine& machine, Word word) {
  Value& cell = machine.frame[fuzz::operand(word, 0)];
  switch (vm::opcode_of(word)) {
    case Opcode::times:
      cell = at(machine, word, 1);
      return Done{};
    case Opcode::times_v:
      cell = std::max(at(machine, word, 1), 0);
      return Done{};
    case Opcode::again:
      cell = wrapped(std::int64_t{cell} - vm::kScale);
      return target_if(cell > 0);
    case Opcode::deadline:
      cell = static_cast<Value>(machine.now + milliseconds(number_at(machine, word, 1)));
      return Done{};
    default:
      return std::nullopt;
  }
}

std::optional<Done> waits(Machine& machine, Word word) {
  switch (vm::opcode_of(word)) {
    case Opcode::wait: {
      const std::uint32_t duration = std::max(milliseconds(number_at(machine, word, 0)), 1U);
      return paused(vm::Pause::until_time, machine.now + duration);
    }
    case Opcode::wait_done:
      return paused(vm::Pause::until_done, Machine::kNever);
    case Opcode::poll:
      return paused(vm::Pause::polling, machine.now + 1);
    case Opcode::until:
      if (truth_at(machine, word, 0) == true)
        return machine.left_ms == 0 ? Done{}
                                    : paused(vm::Pause::satisfied, machine.now + machine.left_ms);
      return paused(vm::Pause::still_polling, machine.wake, true);
    default:
      return std::nullopt;
  }
}

std::optional<Done> jumps(const Machine& machine, Word word) {
  const Opcode opcode = vm::opcode_of(word);
  switch (opcode) {
    case Opcode::loop:
      return Done{};
    case Opcode::jump:
    case Opcode::around_always:
      return target_if(true);
    case Opcode::unless:
      return target_if(truth_at(machine, word, 0) != true);
    case Opcode::unless_known:
      return target_if(!truth_at(machine, word, 0));
    case Opcode::around:
      return target_if(truth_at(machine, word, 0) == true);
    case Opcode::ret:
    case Opcode::ret_number:
      return Done{Went::ended, at(machine, word, 0)};
    case Opcode::end:
      return Done{Went::ended};
    default:
      break;
  }
  if (fuzz::distance_of(opcode).jump != fuzz::Jump::ahead) return std::nullopt;
  const auto truth = relation(opcode, number_at(machine, word, 0), number_at(machine, word, 1));
  return truth ? std::optional(target_if(*truth != true)) : std::nullopt;
}

}  // namespace

Done run(Machine& machine, Word word) {
  const Opcode opcode = vm::opcode_of(word);
  if (acts(machine, word)) return {opcode == Opcode::cmd_end ? Went::ended : Went::on};
  if (const auto done = jumps(machine, word)) return *done;
  if (const auto done = waits(machine, word)) return *done;
  if (const auto done = counts(machine, word)) return *done;
  const auto value = computed(machine, word);
  if (!value)
    throw std::logic_error("tests/oracles/bytecode says nothing about " +
                           std::string(fuzz::info_of(word).name));
  machine.frame[fuzz::operand(word, 0)] = *value;
  return {};
}

}  // namespace robosync::oracle
