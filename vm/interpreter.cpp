// The interpreter: one loop over instruction words, one computed goto per instruction.
//
// Compiled with -O2 on every target; the instruction counts are part of the contract (opcodes.def). It
// trusts the verifier: opcodes are known, operands are in range, and objects end with their
// terminator. Conditions and responses run in the same loop; opcodes for responses only are at its end.
#include "vm/interpreter.hpp"

#include <algorithm>

#include "vm/arithmetic.hpp"
#include "vm/dispatch.hpp"
#include "vm/opcode.hpp"
#include "vm/timers.hpp"

namespace robosync::vm {
namespace {

// Appends to the output; drops an entry that does not fit as a whole.
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

// The whole number of which `b` counts the thousandths. The asm makes gcc use a division, which takes
// two instructions; a multiplication by the reciprocal takes four.
inline std::int32_t whole(Value b) {
  Value scale = kScale;
  asm("" : "+r"(scale));
  return b / scale;
}

// A random number from `b` to `c`, in either order, both inclusive: Marsaglia's xorshift32, scaled to
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

// A duration in thousandths of a second; unknown and negative ones give 0.
std::uint32_t milliseconds(Value duration) {
  return static_cast<std::uint32_t>(std::max<Value>(duration, 0));
}

// Has `time` come? If not, lowers machine.wake to it.
[[gnu::noinline]] Value has_come(Machine& machine, Value time) {
  const auto due = static_cast<std::uint32_t>(time);
  if (reached(due, machine.now)) return kTrue;
  wake_at(machine, due);
  return kFalse;
}

// The time of the step as a value, never kUnknown: 1 ms early, once in 49 days.
Value time_of(const Machine& machine) {
  const auto now = static_cast<Value>(machine.now);
  return now == kUnknown ? kValueMax : now;
}

// The time since `begin`; saturates after 24 days.
Value since(const Machine& machine, Value begin) {
  const std::uint32_t gone = machine.now - static_cast<std::uint32_t>(begin);
  return static_cast<Value>(std::min(gone, static_cast<std::uint32_t>(kValueMax)));
}

// Has `length` passed since `begin`? If not, lowers machine.wake to the time when it will have.
[[gnu::noinline]] Value has_gone_by(Machine& machine, Value begin, Value length) {
  if (length == kUnknown) return kUnknown;
  const Value gone = since(machine, begin);
  if (gone >= length) return kTrue;
  wake_at(machine, machine.now + static_cast<std::uint32_t>(length - gone));
  return kFalse;
}

}  // namespace

// NOLINTNEXTLINE(readability-function-size): the loop's state lives in registers
Value run(Machine& machine, const Word* pc, Progress* progress) {
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
#if defined(__thumb2__)
  const void* const* table = robosync_dispatch;
  asm("" : "+r"(table));  // keeps it in a register
  FETCH();
  // clang-format off
  asm goto(
    FREQUENT_OPCODES(PLACE)
    ".pushsection .rodata.robosync_dispatch, \"a\"\n"
    ".balign 4\n"
    "robosync_dispatch:\n"
#define OPCODE(name, ...)                         \
    ".ifdef .Ldispatch_" #name "\n"               \
    "  .word .Ldispatch_" #name " + 1\n"          \
    ".else\n"                                     \
    "  .word %l[rare] + 1\n"                      \
    ".endif\n"
#include "vm/opcodes.def"
#undef OPCODE
    ".popsection\n"
    JUMP(first));
  // clang-format on
  __builtin_unreachable();
#else
  static const void* const table[] = {
#define OPCODE(name, ...) &&op_##name,
#include "vm/opcodes.def"
#undef OPCODE
  };
  NEXT(first);
#endif

store:
  frame[operand_a(word)] = result;
  NEXT(store);
next:
  NEXT(next);

#if defined(__thumb2__)
rare:
  switch (opcode_of(word)) {
#define OPCODE(name, ...) \
  case Opcode::name:      \
    goto op_##name;
#include "vm/opcodes.def"
#undef OPCODE
    case Opcode::count_:
      break;
  }
  __builtin_unreachable();
#endif

#define SET(name, value)        \
  op_##name : result = (value); \
  goto store
#define SET_HOT(name, value)                    \
  op_##name : frame[operand_a(word)] = (value); \
  NEXT(name)

  SET_HOT(move, b());
  SET_HOT(load, wide_k());
  SET(mul, multiply(b(), c()));
  SET(random, draw(machine, b(), c()));
  SET(neg, negate(b()));
  SET(abs, absolute(b()));
  SET(round, round_to(b(), c()));
  SET(now, time_of(machine));
  SET(elapsed, since(machine, b()));
  SET(lasted, has_gone_by(machine, b(), c()));
  SET(div_k, divide_by_whole(b(), k()));
  SET_HOT(add_fast, add_unchecked(b(), c()));
  SET_HOT(add_k_fast, add_unchecked(b(), k()));
  SET_HOT(mul_fast, multiply_unchecked(whole(b()), c()));
  SET(mul_k_fast, multiply_unchecked(b(), k()));

  SET(and_, b() & c());
  SET(or_, b() | c());
  SET(not_, logical_not(b()));
#undef SET_HOT
#undef SET

op_sub:
  right = negate(c());
  goto sum;
op_mod_k:
  result = b();
  if (result == kUnknown) goto store;
  frame[operand_a(word)] = modulo_positive(result, k());
  NEXT(mod_k);
op_add:
  right = c();
sum:
  result = right;
  if (right == kUnknown) goto store;
  result = b();
  if (result == kUnknown) goto store;
  frame[operand_a(word)] = add_known(result, right);
  NEXT(sum);
op_add_k:
  result = b();
  if (result == kUnknown) goto store;
  frame[operand_a(word)] = add_known(result, k());
  NEXT(add_k);

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

op_min:  // unknown is less than every known value
  result = b();
  right = c();
  if (result > right) result = right;
  goto store;
op_max:
  result = c();
  if (result == kUnknown) goto store;
  right = b();
  if (right == kUnknown || result < right) result = right;
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

// A comparison of two cells, which continues as one with a constant once its right operand is known. A
// constant is always known: the verifier has checked that.
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
  result = b();
  if (result == kUnknown) goto next;
  machine.assigned |= 1U << operand_a(word);
  goto store;
op_shift:
  result = b();
  if (result == kUnknown) goto next;
  machine.shifted |= 1U << operand_a(word);
  goto store;

op_unless:
  if (a() != kTrue) goto ahead;
  goto next;
op_unless_known:
  if (a() == kUnknown) goto ahead;
  goto next;
  // Unknown is less than every known value. So with an unknown right side neither `<` nor `<=` is true,
  // and with an unknown left side neither `>` nor `>=`.
#define UNLESS(name, holds)                     \
  op_unless_##name : right = b();               \
  goto unless_##name;                           \
  op_unless_##name##_k : right = b_k();         \
  unless_##name : result = a();                 \
  if (result != kUnknown && (holds)) goto next; \
  goto ahead8

  UNLESS(lt, result < right);
  UNLESS(le, result <= right);
  UNLESS(eq, result == right);
  UNLESS(ne, right != kUnknown && result != right);
#undef UNLESS
op_unless_gt_k:
  if (a() > b_k()) goto next;
  goto ahead8;
op_unless_ge_k:
  if (a() >= b_k()) goto next;
ahead8:
  pc += operand_c(word);
  goto next;
op_jump:
ahead:
  pc += operand_wide(word);
  goto next;

  // A loop's cell contains the number of remaining rounds, including the current one.
op_times:
  result = wide_k();
  goto store;
op_times_v:
  result = std::max<Value>(b(), 0);
  goto store;
op_again:
  result = a() - kScale;
  frame[operand_a(word)] = result;
  if (result <= 0) goto next;
  pc -= operand_wide(word);
  NEXT(again);
op_loop:
  goto next;
op_around:
  if (a() != kTrue) goto next;
op_around_always:
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
  if (a() == kTrue) {
    if (machine.left_ms == 0) goto next;
    wake = machine.now + machine.left_ms;
    pause = Pause::satisfied;
    goto give_up;
  }
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
  return kUnknown;
}

}  // namespace robosync::vm
