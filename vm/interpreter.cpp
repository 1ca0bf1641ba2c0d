// The interpreter: one loop over instruction words, one computed goto an instruction.
//
// Compiled -O2 on every target; the instruction counts are part of the contract (opcodes.def). It
// trusts the verifier: opcodes are known, operands in range, objects end with their terminator.
// Conditions and responses run in the same loop; what responses alone have is at its end.
#include "vm/interpreter.hpp"

#include <algorithm>

#include "vm/arithmetic.hpp"
#include "vm/opcode.hpp"
#include "vm/timers.hpp"

namespace robosync::vm {
namespace {

// The opcodes that are reached at once. `asm goto` takes no more than these; the others are reached
// by way of a switch, which takes them three instructions more. (clang-format never comes to rest
// on this list.)
// clang-format off
#define FREQUENT_OPCODES(X)                                                  \
  X(move) X(load) X(add) X(sub) X(mul) X(div) X(mod)                         \
  X(lt) X(le) X(eq) X(ne) X(lt_k) X(le_k) X(gt_k) X(ge_k) X(eq_k) X(ne_k)    \
  X(and_) X(or_) X(not_) X(ret)                                              \
  X(arg) X(arg_k) X(cmd) X(cmd_end) X(end) X(again)
// clang-format on

constexpr bool is_frequent(Opcode opcode) {
#define IS_IT(name) opcode == Opcode::name ||
  return FREQUENT_OPCODES(IS_IT) false;
#undef IS_IT
}

// Appends to the output; what does not fit is dropped as a whole.
inline void put(Machine& machine, Word word) {
  Word* const output = machine.output;
  if (output == machine.output_end) return;
  *output = word;
  machine.output = output + 1;
}
inline void put(Machine& machine, Word word, Value value) {
  Word* const output = machine.output;
  if (machine.output_end - output < 2) return;
  output[0] = word;
  output[1] = static_cast<Word>(value);
  machine.output = output + 2;
}

// A number from `b` to `c`, in whichever order, both included: Marsaglia's xorshift32, spread over
// the range by its upper bits. No number is favoured by more than range / 2^32.
[[gnu::noinline]] Value draw(Machine& machine, Value b, Value c) {
  if (b == kUnknown || c == kUnknown) return kUnknown;
  std::uint32_t random = machine.random;
  random ^= random << 13;
  random ^= random >> 17;
  random ^= random << 5;
  machine.random = random;
  const auto least = static_cast<std::uint32_t>(std::min(b, c));
  const std::uint32_t count = static_cast<std::uint32_t>(std::max(b, c)) - least + 1;
  return static_cast<Value>(least +
                            static_cast<std::uint32_t>(std::uint64_t{random} * count >> 32));
}

// A duration is thousandths of a second; unknown and negative ones are none.
std::uint32_t milliseconds(Value duration) {
  return static_cast<std::uint32_t>(std::max<Value>(duration, 0));
}

// Is it `time` now, or later? If not, it wakes the machine then.
[[gnu::noinline]] Value has_come(Machine& machine, Value time) {
  const auto due = static_cast<std::uint32_t>(time);
  if (static_cast<std::int32_t>(machine.now - due) >= 0) return kTrue;
  wake_at(machine, due);
  return kFalse;
}

}  // namespace

// NOLINTNEXTLINE(readability-function-size): the loop's state lives in registers
Value run(Machine& machine, const Word* pc, Progress* progress) {
#if defined(__thumb2__)
#define LABEL(label) reinterpret_cast<const char*>(&&label) + 1  // bit 0: Thumb code
#else
#define LABEL(label) &&label
#endif
  static const void* const kLabels[] = {
#define OPCODE(name, a, b, c, contexts, cost, doc) \
  is_frequent(Opcode::name) ? LABEL(op_##name) : LABEL(rare),
#include "vm/opcodes.def"
#undef OPCODE
  };
#undef LABEL

  Value* const frame = machine.frame;
  const Value* const constants = machine.constants;
  Word word = 0;
  Value result = kUnknown;
  Value right = kUnknown;
  Pause pause = Pause::ended;
  std::uint32_t wake = Machine::kNever;
  const auto a = [&] { return frame[operand_a(word)]; };
  const auto b = [&] { return frame[operand_b(word)]; };
  const auto c = [&] { return frame[operand_c(word)]; };
  const auto k = [&] { return constants[operand_c(word)]; };
  const auto b_k = [&] { return constants[operand_b(word)]; };
  const auto wide_k = [&] { return constants[operand_wide(word)]; };
  goto next;
store:
  frame[operand_a(word)] = result;
next:
  word = *pc;
  ++pc;
  // Without this, gcc keeps the `pc` of a jump in a register of its own, and every instruction pays
  // for moving it.
  asm volatile("" : "+r"(pc));
#if defined(__thumb2__)
  // gcc makes five instructions of `goto*` (it sets the Thumb bit each time); three are enough.
#define TARGET(name) , op_##name
  asm goto("ldr pc, [%0, %1, lsl #2]"
           :
           : "r"(kLabels), "r"(word & 0xFF)
           :
           : rare FREQUENT_OPCODES(TARGET));
#undef TARGET
  __builtin_unreachable();
#else
  goto* kLabels[word & 0xFF];
#endif

rare:
  switch (opcode_of(word)) {
#define OPCODE(name, a, b, c, contexts, cost, doc) \
  case Opcode::name:                               \
    goto op_##name;
#include "vm/opcodes.def"
#undef OPCODE
    case Opcode::count_:
      break;
  }
  __builtin_unreachable();

#define SET(name, value)        \
  op_##name : result = (value); \
  goto store

  SET(move, b());
  SET(load, wide_k());
  SET(mul, multiply(b(), c()));
  SET(random, draw(machine, b(), c()));
  SET(neg, negate(b()));
  SET(add_k, add(b(), k()));
  SET(div_k, divide_by_whole(b(), k()));
  SET(mod_k, modulo(b(), k()));
  SET(add_fast, add_unchecked(b(), c()));
  SET(add_k_fast, add_unchecked(b(), k()));
  SET(mul_fast, multiply_unchecked(b() / kScale, c()));
  SET(mul_k_fast, multiply_unchecked(b(), k()));

  SET(and_, b() & c());
  SET(or_, b() | c());
  SET(not_, logical_not(b()));
#undef SET

op_sub:
  right = negate(c());
  goto sum;
op_add:
  right = c();
sum:
  result = add(b(), right);
  goto store;

op_div:
  right = c();
  if (right == 0) goto zero_divide;
  result = divide(b(), right);
  goto store;
op_mod:
  right = c();
  if (right == 0) goto zero_divide;
  result = modulo(b(), right);
  goto store;
zero_divide:
  result = b();
  if (result == kUnknown) goto store;
  machine.divided_by_zero = true;
  result = 0;
  goto store;

op_min_k:
  result = b();
  right = k();
  if (result > right) result = right;
  goto store;
op_max_k:
  result = b();
  right = k();
  if (result != kUnknown && result < right) result = right;
  goto store;

// A comparison with a constant, and one of two cells that becomes the first once the right one is
// known. A constant is: the verifier has looked.
#define COMPARE(name, relation)                             \
  op_##name : right = c();                                  \
  result = right;                                           \
  if (right == kUnknown) goto store;                        \
  goto name##_known;                                        \
  op_##name##_k : right = k();                              \
  name##_known : result = b();                              \
  if (result != kUnknown) result = relation(result, right); \
  goto store

  COMPARE(lt, is_less);
  COMPARE(le, is_not_greater);
  COMPARE(eq, is_equal);
  COMPARE(ne, is_not_equal);
#undef COMPARE

op_gt_k:
  result = b();
  if (result != kUnknown) result = is_greater(result, k());
  goto store;
op_ge_k:
  result = b();
  if (result != kUnknown) result = is_not_less(result, k());
  goto store;

op_held:
op_counted:
op_sequence:
op_latch:
op_rose:
op_changed:
  result = time_word(machine, word);
  goto store;

op_ret:
op_ret_number:
  return a();

op_arg:
  result = b();
  goto put_param;
op_arg_k:
  result = wide_k();
put_param:
  put(machine, word, result);
  goto next;
op_cmd:
  put(machine, word);
  goto next;
op_log:
op_alert:
op_halt:
  put(machine, word);
  goto next;

op_set:
  machine.assigned |= (b() != kUnknown ? 1U : 0U) << operand_a(word);
op_shift:
  result = b();
  if (result == kUnknown) goto next;
  machine.written |= 1U << operand_a(word);
  goto store;

op_unless:
  if (a() != kTrue) goto ahead;
  goto next;
op_unless_known:
  if (a() == kUnknown) goto ahead;
  goto next;
  // An unknown is less than all that is known. So an unknown right side makes no order true, and an
  // unknown left side none that wants it greater.
#define UNLESS(name, right_side, holds) \
  op_unless_##name : result = a();      \
  right = right_side;                   \
  if (holds) goto next;                 \
  goto ahead8

  UNLESS(lt, b(), result != kUnknown && result < right);
  UNLESS(le, b(), result != kUnknown && result <= right);
  UNLESS(eq, b(), result != kUnknown && result == right);
  UNLESS(ne, b(), result != kUnknown && right != kUnknown && result != right);
  UNLESS(lt_k, b_k(), result != kUnknown && result < right);
  UNLESS(le_k, b_k(), result != kUnknown && result <= right);
  UNLESS(gt_k, b_k(), result > right);
  UNLESS(ge_k, b_k(), result >= right);
  UNLESS(eq_k, b_k(), result == right);
  UNLESS(ne_k, b_k(), result != kUnknown && result != right);
#undef UNLESS
ahead8:
  pc += operand_c(word);
  goto next;
op_jump:
ahead:
  pc += operand_wide(word);
  goto next;

  // A loop's cell says how often it has still to run, this time included.
op_times:
  result = wide_k();
  goto store;
op_times_v:
  result = std::max<Value>(b(), 0);
  goto store;
op_again:
  result = a() - kScale;
  frame[operand_a(word)] = result;
  if (result > 0) goto back;
op_loop:
  goto next;
op_around:
  if (a() != kTrue) goto next;
op_around_always:
back:
  pc -= operand_wide(word);
  goto next;

op_deadline:
  result = static_cast<Value>(machine.now + milliseconds(b()));
  goto store;
op_reached:
  result = has_come(machine, b());
  goto store;

op_wait:
  wake = machine.now + std::max<std::uint32_t>(milliseconds(a()), 1);
  pause = Pause::until_time;
  goto give_up;
op_wait_done:
  pause = Pause::until_done;
  goto give_up;
op_until:
  if (a() == kTrue) goto next;
  pc -= operand_wide(word);
  wake = machine.wake;
  pause = Pause::still_polling;
  goto give_up;
op_poll:
  wake = machine.now + 1;
  pause = Pause::polling;
give_up:
  *progress = {pause, pc, wake};
  return kUnknown;

op_cmd_end:
  put(machine, word);
op_end:
  // Not an empty block: gcc would send the jumps elsewhere and leave the label, whose address is in
  // the table, where it happens to be.
  asm volatile("");
  return kUnknown;
}

}  // namespace robosync::vm
