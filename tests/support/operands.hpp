// An instruction word by the kinds of its operands, as opcodes.def lists them: whatever opcodes
// there are, nothing here knows them by name.
#pragma once

#include "vm/opcode.hpp"

namespace robosync::fuzz {

using vm::Opcode;
using vm::Operand;
using vm::Word;

constexpr std::size_t kPlaces = 3;  // A, B, C
constexpr std::size_t kOpcodeCount = vm::kOpcodes.size();

constexpr bool is_opcode(Word word) {
  return (word & 0xFF) < kOpcodeCount;
}
// Of a word that is_opcode().
constexpr const vm::OpcodeInfo& info_of(Word word) {
  return vm::kOpcodes[word & 0xFF];
}
constexpr Operand kind_of(Word word, std::size_t place) {
  return info_of(word).operands[place];
}
constexpr bool has_context(Opcode opcode, vm::Context context) {
  const auto contexts = static_cast<unsigned>(vm::info_of(opcode).contexts);
  return (contexts & static_cast<unsigned>(context)) != 0;
}

constexpr unsigned operand(Word word, std::size_t place) {
  return vm::is_wide(kind_of(word, place)) ? word >> 16 : word >> (8 + 8 * place) & 0xFF;
}
constexpr Word with_operand(Word word, std::size_t place, unsigned value) {
  const unsigned shift = 8 + 8 * static_cast<unsigned>(place);
  const Word mask = (vm::is_wide(kind_of(word, place)) ? 0xFFFFU : 0xFFU) << shift;
  return (word & ~mask) | (value << shift & mask);
}

enum class Jump : std::uint8_t { none, ahead, back };

// Where in the word its distance stands, and which way it goes.
struct Distance {
  Jump jump = Jump::none;
  std::size_t place = 0;
};
constexpr Distance distance_of(Opcode opcode) {
  const auto& kinds = vm::info_of(opcode).operands;
  for (std::size_t place = 0; place < kPlaces; ++place) {
    if (kinds[place] == Operand::ahead || kinds[place] == Operand::ahead8)
      return {Jump::ahead, place};
    if (kinds[place] == Operand::back) return {Jump::back, place};
  }
  return {};
}

constexpr vm::Flow flow_of(Opcode opcode) {
  return vm::info_of(opcode).flow;
}
constexpr vm::Effect effect_of(Opcode opcode) {
  return vm::info_of(opcode).effect;
}
// Do words with the one look like words with the other, whatever their constants must be?
constexpr bool look_alike(Opcode one, Opcode other) {
  for (std::size_t place = 0; place < kPlaces; ++place)
    if (vm::widened(vm::info_of(one).operands[place]) !=
        vm::widened(vm::info_of(other).operands[place]))
      return false;
  return true;
}

}  // namespace robosync::fuzz
