// Opcodes and what is known of each at compile time, derived from opcodes.def.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "vm/image.hpp"

namespace robosync::vm {

enum class Opcode : std::uint8_t {
#define OPCODE(name, a, b, c, contexts, cost, doc) name,
#include "vm/opcodes.def"
#undef OPCODE
  count_
};

// What a byte of an instruction word means; opcodes.def explains each.
enum class Operand : std::uint8_t {
  none,
  write,
  read,
  const8,
  const16,
  param,
  target,
  verb,
  word,
  write_truth,
  write_same,
  read_truth,
  update_truth,
  local,
  variable,
  ahead,
  ahead8,
  back,
  timer,
  string
};

// Where an opcode may stand: bits.
enum class Context : std::uint8_t { condition = 1, response = 2, safety = 4, acting = 6, any = 7 };

struct OpcodeInfo {
  std::string_view name;
  std::array<Operand, 3> operands;  // A, B, C; wide kinds in B take C too
  Context contexts;
  std::uint16_t cost;  // worst-case Cortex-M4 instructions, dispatch included
  std::string_view doc;
};

inline constexpr std::array<OpcodeInfo, static_cast<std::size_t>(Opcode::count_)> kOpcodes = {{
#define OPCODE(name, a, b, c, contexts, cost, doc) \
  {#name, {Operand::a, Operand::b, Operand::c}, Context::contexts, cost, doc},
#include "vm/opcodes.def"
#undef OPCODE
}};

// Does a code object end with this opcode? Every object has exactly one of them, as its last word.
constexpr bool is_terminator(Opcode op) {
  return op == Opcode::ret || op == Opcode::ret_number || op == Opcode::cmd_end ||
         op == Opcode::end;
}

// Does it begin a block that ends at its target? IF.
constexpr bool is_unless(Opcode op) {
  return op >= Opcode::unless && op <= Opcode::unless_ne_k;
}

// Does this operand take the bytes of B and C together?
constexpr bool is_wide(Operand kind) {
  return kind == Operand::const16 || kind == Operand::ahead || kind == Operand::back ||
         kind == Operand::string;
}

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

// Changes whenever opcodes.def changes in a way that old images would be misread (names, order,
// operands): 16 bits of an FNV-1a hash over them. Compared on both ends before an image runs.
constexpr std::uint16_t opcode_set_id() {
  std::uint32_t hash = 2166136261u;
  for (const OpcodeInfo& info : kOpcodes) {
    for (const char c : info.name)
      hash = (hash ^ static_cast<std::uint8_t>(c)) * 16777619u;
    for (const Operand o : info.operands)
      hash = (hash ^ static_cast<std::uint8_t>(o)) * 16777619u;
  }
  return static_cast<std::uint16_t>(hash ^ (hash >> 16));
}

}  // namespace robosync::vm
