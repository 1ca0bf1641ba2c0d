// The opcodes and their compile-time properties, derived from opcodes.def.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "vm/image.hpp"

namespace robosync::vm {

enum class Opcode : std::uint8_t {
#define OPCODE(name, ...) name,
#include "vm/opcodes.def"
#undef OPCODE
  count_
};

// What a byte of an instruction word means; opcodes.def explains each kind. The numbers are part of
// the opcode set's id: a new kind takes the next number.
enum class Operand : std::uint8_t {
  none = 0,
  write = 1,
  read = 2,
  const8 = 3,
  const16 = 4,
  param = 5,
  target = 6,
  verb = 7,
  word = 8,
  write_truth = 9,
  write_same = 10,
  read_truth = 11,
  update_truth = 12,
  local = 13,
  variable = 14,
  ahead = 15,
  ahead8 = 16,
  back = 17,
  timer = 18,
  string = 19,
  positive8 = 20,
  divisor8 = 21,
  count16 = 22,
  whole8 = 23
};

// Where an opcode is allowed: bits.
enum class Context : std::uint8_t { condition = 1, response = 2, safety = 4, acting = 6, any = 7 };

// Which instruction runs next.
enum class Flow : std::uint8_t {
  next,
  end,
  if_begin,
  if_else,
  count_begin,
  loop_begin,
  poll_begin,
  count_end,
  loop_end,
  poll_end,
  pause
};

// The effects of an instruction besides writing to the frame.
enum class Effect : std::uint8_t {
  none,
  division,
  event,
  draw,
  clock,
  set,
  param,
  command,
  log,
  alert,
  halt
};

struct OpcodeInfo {
  std::string_view name;
  std::array<Operand, 3> operands;  // A, B, C; a wide kind in B includes C
  Context contexts;
  Flow flow;
  Effect effect;
  std::uint16_t cost;  // worst-case Cortex-M4 instructions, including dispatch
  std::string_view doc;
};

// For the host. The board has no room for names and documentation: it uses the table that
// opcode_traits.hpp makes from this.
inline constexpr std::array<OpcodeInfo, static_cast<std::size_t>(Opcode::count_)> kOpcodes = {{
#define OPCODE(name, a, b, c, contexts, flow, effect, cost, doc) \
  {                                                              \
      #name,                                                     \
      {Operand::a, Operand::b, Operand::c},                      \
      Context::contexts,                                         \
      Flow::flow,                                                \
      Effect::effect,                                            \
      cost,                                                      \
      doc},
#include "vm/opcodes.def"
#undef OPCODE
}};

constexpr const OpcodeInfo& info_of(Opcode opcode) {
  return kOpcodes[static_cast<std::size_t>(opcode)];
}

// ---- properties of operand kinds

// Does it take the bytes of B and C together?
constexpr bool is_wide(Operand kind) {
  return kind == Operand::const16 || kind == Operand::count16 || kind == Operand::ahead ||
         kind == Operand::back || kind == Operand::string;
}
// Is it a cell to which the instruction writes a number or a truth?
constexpr bool is_written(Operand kind) {
  return kind == Operand::write || kind == Operand::write_truth || kind == Operand::write_same ||
         kind == Operand::update_truth || kind == Operand::local || kind == Operand::variable;
}
// Is it a cell that is read or set and may be an input?
constexpr bool may_be_input(Operand kind) {
  return kind == Operand::read || kind == Operand::read_truth || kind == Operand::variable;
}
// Is the constant the number itself, not its thousandths?
constexpr bool is_whole(Operand kind) {
  return kind == Operand::whole8 || kind == Operand::divisor8;
}
// Must the constant be above 0?
constexpr bool is_positive(Operand kind) {
  return kind == Operand::positive8 || kind == Operand::divisor8 || kind == Operand::count16;
}
// The kind that this one narrows, if any: the encoding is the same, but fewer operands are allowed.
constexpr Operand widened(Operand kind) {
  switch (kind) {
    case Operand::positive8:
    case Operand::whole8:
    case Operand::divisor8:
      return Operand::const8;
    case Operand::count16:
      return Operand::const16;
    default:
      return kind;
  }
}

// ---- properties of flows

// Does it leave blocks, and what is known inside them, unchanged?
constexpr bool is_straight(Flow flow) {
  return flow == Flow::next || flow == Flow::end;
}
constexpr bool begins_loop(Flow flow) {
  return flow == Flow::count_begin || flow == Flow::loop_begin || flow == Flow::poll_begin;
}
constexpr bool ends_loop(Flow flow) {
  return flow == Flow::count_end || flow == Flow::loop_end || flow == Flow::poll_end;
}
// The end of a loop with this begin.
constexpr Flow end_of(Flow begin) {
  switch (begin) {
    case Flow::count_begin:
      return Flow::count_end;
    case Flow::loop_begin:
      return Flow::loop_end;
    default:
      return Flow::poll_end;
  }
}
// Does the run always stop here, and continue in a later step?
constexpr bool always_pauses(Flow flow) {
  return flow == Flow::pause || flow == Flow::poll_begin;
}
// May the run stop here?
constexpr bool may_pause(Flow flow) {
  return always_pauses(flow) || flow == Flow::poll_end;
}

// Words of output.
constexpr unsigned output_words(Effect effect) {
  switch (effect) {
    case Effect::none:
    case Effect::division:
    case Effect::event:
    case Effect::draw:
    case Effect::clock:
    case Effect::set:
      return 0;
    case Effect::param:
      return 2;
    case Effect::command:
    case Effect::log:
    case Effect::alert:
    case Effect::halt:
      return 1;
  }
  return 0;
}

// By TimerKind: the time word that uses timers of this kind.
inline constexpr std::array<Opcode, static_cast<std::size_t>(TimerKind::count_)> kTimeWords = {
#define TIMER(name, words, counts, doc) Opcode::name,
#include "vm/timers.def"
#undef TIMER
};
constexpr Opcode time_word_of(TimerKind kind) {
  return kTimeWords[static_cast<std::size_t>(kind)];
}
// The kind of timers that it uses; count_ if it is no time word.
constexpr TimerKind timer_kind_of(Opcode time_word) {
  std::size_t kind = 0;
  while (kind < kTimeWords.size() && kTimeWords[kind] != time_word)
    ++kind;
  return static_cast<TimerKind>(kind);
}
static_assert(
    [] {
      for (std::size_t i = 0; i < kOpcodes.size(); ++i) {
        const bool remembers = kOpcodes[i].operands[2] == Operand::timer;
        if (remembers != (timer_kind_of(static_cast<Opcode>(i)) != TimerKind::count_)) return false;
      }
      return true;
    }(),
    "time words stand in both lists");

// ---- words

constexpr Word encode(Opcode op, unsigned a = 0, unsigned b = 0, unsigned c = 0) {
  return static_cast<Word>(op) | (a << 8) | (b << 16) | (c << 24);
}
constexpr Word encode_wide(Opcode op, unsigned a, unsigned bc) {
  return static_cast<Word>(op) | (a << 8) | (bc << 16);
}
constexpr Opcode opcode_of(Word word) {
  return static_cast<Opcode>(word & 0xFF);
}
constexpr std::uint8_t operand_a(Word word) {
  return static_cast<std::uint8_t>(word >> 8);
}
constexpr std::uint8_t operand_b(Word word) {
  return static_cast<std::uint8_t>(word >> 16);
}
constexpr std::uint8_t operand_c(Word word) {
  return static_cast<std::uint8_t>(word >> 24);
}
constexpr std::uint16_t operand_wide(Word word) {
  return static_cast<std::uint16_t>(word >> 16);
}

// Changes whenever opcodes.def changes such that old images would be misread (names, order, operands):
// 16 bits of an FNV-1a hash over them. Both ends compare it before an image runs. The verifier checks
// which operands are allowed, so a narrowed kind counts as the kind that it narrows.
constexpr std::uint16_t opcode_set_id() {
  std::uint32_t hash = 2166136261u;
  for (const OpcodeInfo& info : kOpcodes) {
    for (const char c : info.name)
      hash = (hash ^ static_cast<std::uint8_t>(c)) * 16777619u;
    for (const Operand o : info.operands)
      hash = (hash ^ static_cast<std::uint8_t>(widened(o))) * 16777619u;
  }
  return static_cast<std::uint16_t>(hash ^ (hash >> 16));
}

}  // namespace robosync::vm
