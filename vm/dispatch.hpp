// How the interpreter comes from one opcode to the next: by a table of where each one's code
// begins. For interpreter.cpp only.
//
// On the board the assembler makes the table, out of the labels that the interpreter's first
// `asm goto` names. gcc makes five instructions of `goto*` (it sets the Thumb bit each time), and
// where addresses of labels are taken it keeps code for jumps that never come. Assumes the
// variables `pc`, `word` and `table`, and a label op_NAME for each opcode; on the board also
// `rare`, where all go that are not frequent.
#pragma once

// The opcodes that are reached at once: those of the measured programs, and what the examples have
// most of. `asm goto` takes no more than these; the others are reached by way of a switch, which
// takes them three instructions more. (clang-format never comes to rest on this list.)
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
// `place` tells the copies apart: gcc would make one of them again.
// clang-format off
#define JUMP(place)                           \
  "ldr pc, [%0, %1, lsl #2] @ " #place        \
      :: "r"(table), "r"(word & 0xFF) : : rare FREQUENT_OPCODES(TARGET)
// clang-format on
#define DISPATCH(place)  \
  asm goto(JUMP(place)); \
  __builtin_unreachable()
#else
// NOLINTNEXTLINE(bugprone-macro-parentheses): no product, a statement
#define DISPATCH(place) goto* table[word & 0xFF]
#endif

// Without the `asm`, gcc keeps the `pc` of a jump in a register of its own, and every instruction
// pays for moving it.
#define FETCH() \
  word = *pc;   \
  ++pc;         \
  asm volatile("" : "+r"(pc))
// What stands at the end of a frequent opcode instead of a jump to `next`.
#define NEXT(place) \
  FETCH();          \
  DISPATCH(place)
