// What a step concerns: the inputs that the code of a rule reads or sets, and the constants that it compares them with.
// Pure. The runtime builds its index from inputs to rules with it (layers/loaded_program.cpp), and finds out which readings make a
// difference to rules (layers/thresholds.cpp); analysis/ builds its own index. layers/processing.cpp explains why a step may skip
// the rules that it does not concern. Images are verified.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "runtime-m4/policy/threads.hpp"
#include "vm/image.hpp"
#include "vm/opcode.hpp"

namespace robosync::policy {

// What is to be known of an opcode here. Bit i of the lowest three: operand i is a cell that may be an input.
inline constexpr unsigned kInputOperands = 7;
inline constexpr unsigned kCompares =
    8;  // B with the constant C: the result changes only if B reaches or passes C
inline constexpr unsigned kSteady =
    16;  // in a condition: with the same operands it has the same result, and no effect
inline constexpr unsigned kPolls =
    32;  // what follows is evaluated in each step that changes an input of the behaviour

constexpr unsigned uses_of(const vm::OpcodeInfo& info) {
  using vm::Operand;
  constexpr std::array kComparison = {Operand::write_truth, Operand::read, Operand::const8};
  unsigned uses = 0;
  for (unsigned i = 0; i < info.operands.size(); ++i)
    if (vm::may_be_input(info.operands[i])) uses |= 1U << i;
  if (info.operands == kComparison) uses |= kCompares;
  if (info.effect == vm::Effect::none) uses |= kSteady;
  if (info.flow == vm::Flow::poll_begin) uses |= kPolls;
  return uses;
}

// By opcode. A separate table, because vm::kOpcodes also contains the documentation, which the board does not store.
inline constexpr std::array<std::uint8_t, vm::kOpcodes.size()> kUses = [] {
  std::array<std::uint8_t, vm::kOpcodes.size()> uses{};
  for (std::size_t op = 0; op < uses.size(); ++op)
    uses[op] = static_cast<std::uint8_t>(uses_of(vm::kOpcodes[op]));
  return uses;
}();
inline bool uses(vm::Word word, unsigned what) {
  return (kUses[word & 0xFF] & what) != 0;
}

template <class Take>
void each_input_of_word(const vm::Image& image, const vm::Behavior& behavior, vm::Word word,
                        Take take) {
  for (unsigned places = kUses[word & 0xFF] & kInputOperands; places != 0; places >>= 1) {
    word >>= 8;
    const std::size_t cell = word & 0xFF;
    if ((places & 1) != 0 && cell < behavior.input_count)
      take(image.inputs[behavior.first_input + cell]);
  }
}

// Calls take(input) each time the code reads or sets an input.
template <class Take>
void each_input(const vm::Image& image, const vm::Behavior& behavior, std::uint16_t start,
                std::uint16_t length, Take take) {
  for (const vm::Word word : image.code.subspan(start, length))
    each_input_of_word(image, behavior, word, take);
}

template <class Take>
void each_input_of_condition(const vm::Image& image, const vm::Behavior& behavior,
                             const vm::Rule& rule, Take take) {
  each_input(image, behavior, rule.condition_start, rule.condition_length, take);
}

// Includes the inputs of its responses: they concern the behaviour too, for responses that wait.
template <class Take>
void each_input_of_rule(const vm::Image& image, const vm::Behavior& behavior, const vm::Rule& rule,
                        Take take) {
  each_input_of_condition(image, behavior, rule, take);
  for (const std::uint16_t index : {rule.then_response, rule.else_response}) {
    if (index == vm::kNoIndex) continue;
    const vm::Response& response = image.responses[index];
    each_input(image, behavior, response.start, response.length, take);
  }
}

// Calls take(channel, constant) for each comparison of a channel with a constant in the conditions of rules, except SAFETY
// rules; `constant` is an index.
template <class Take>
void each_comparison(const vm::Image& image, Take take) {
  for (const vm::Behavior& behavior : image.behaviors.subspan(first_behavior(image)))
    for (const vm::Rule& rule : image.rules.subspan(behavior.first_rule, behavior.rule_count))
      for (const vm::Word word : image.code.subspan(rule.condition_start, rule.condition_length)) {
        if (!uses(word, kCompares)) continue;
        each_input_of_word(image, behavior, word, [&](std::uint8_t input) {
          if (input < image.channels.size()) take(input, vm::operand_c(word));
        });
      }
}

}  // namespace robosync::policy
