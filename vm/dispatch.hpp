// How the interpreter jumps from one opcode to the next: through a table of the addresses of their
// code. For interpreter.cpp only.
//
// On the board the assembler builds the table, from the labels that the interpreter's first
// `asm goto` names. gcc compiles `goto*` to five instructions (it sets the Thumb bit each time), and
// if addresses of labels are taken, it keeps code for jumps that never happen. Assumes the variables
// `pc`, `word` and `table`, and a label op_NAME for each opcode; on the board also the label `rare`,
// which handles all opcodes that are not frequent.
#pragma once

// The opcodes that are reached directly: those of the measured programs, and the most frequent ones of
// the examples. `asm goto` accepts no more labels than these; the others are reached through a switch,
// which costs three more instructions. (clang-format does not converge on this list.)
// clang-format off
#define FREQUENT_OPCODES(X)                                                  \
  X(move) X(load) X(add) X(sub) X(mul)                                       \
  X(add_k) X(div_k) X(mod_k) X(add_fast) X(add_k_fast) X(mul_fast)           \
  X(lt_k) X(gt_k) X(ge_k) X(eq_k) X(and_) X(ret)                             \
  X(unless) X(unless_lt_k) X(unless_gt_k) X(again)                           \
  X(set) X(arg) X(arg_k) X(cmd) X(cmd_end) X(end)
// clang-format on

#if defined(__thumb2__)
extern "C" const void* const robosync_dispatch[];
#define TARGET(name) , op_##name
#define PLACE(name) ".set .Ldispatch_" #name ", %l[op_" #name "]\n"
// `place` makes the copies differ, so that gcc does not merge them.
// clang-format off
#define JUMP(place)                           \
  "ldr pc, [%0, %1, lsl #2] @ " #place        \
      :: "r"(table), "r"(word & 0xFF) : : rare FREQUENT_OPCODES(TARGET)
// clang-format on
#define DISPATCH(place)  \
  asm goto(JUMP(place)); \
  __builtin_unreachable()
#else
// NOLINTNEXTLINE(bugprone-macro-parentheses): a statement, no product
#define DISPATCH(place) goto* table[word & 0xFF]
#endif

// Without the `asm`, gcc keeps the `pc` of a jump in a separate register, and every instruction has to
// move it.
#define FETCH() \
  word = *pc;   \
  ++pc;         \
  asm volatile("" : "+r"(pc))
// Ends a frequent opcode, instead of a jump to `next`.
#define NEXT(place) \
  FETCH();          \
  DISPATCH(place)
