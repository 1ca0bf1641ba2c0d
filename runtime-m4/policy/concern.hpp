// What a step concerns: the inputs that the code of a rule reads or sets. Pure. The runtime builds its
// index from inputs to rules with it (layers/loaded_program.cpp); analysis/ builds its own.
// layers/processing.cpp explains why a step may skip the rules that it does not concern. Images are
// verified.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "vm/image.hpp"
#include "vm/opcode.hpp"

namespace robosync::policy {

// By opcode, bit i: operand i is a cell that may be an input. A separate table, because vm::kOpcodes
// also contains the documentation, which the board does not store.
inline constexpr std::array<std::uint8_t, vm::kOpcodes.size()> kInputOperands = [] {
  std::array<std::uint8_t, vm::kOpcodes.size()> inputs{};
  for (std::size_t op = 0; op < inputs.size(); ++op) {
    unsigned mask = 0;
    for (unsigned i = 0; i < vm::kOpcodes[op].operands.size(); ++i)
      if (vm::may_be_input(vm::kOpcodes[op].operands[i])) mask |= 1U << i;
    inputs[op] = static_cast<std::uint8_t>(mask);
  }
  return inputs;
}();

// Calls take(input) each time the code reads or sets an input.
template <class Take>
void each_input(const vm::Image& image, const vm::Behavior& behavior, std::uint16_t start,
                std::uint16_t length, Take take) {
  for (vm::Word word : image.code.subspan(start, length)) {
    for (unsigned places = kInputOperands[word & 0xFF]; places != 0; places >>= 1) {
      word >>= 8;
      const std::size_t cell = word & 0xFF;
      if ((places & 1) != 0 && cell < behavior.input_count)
        take(image.inputs[behavior.first_input + cell]);
    }
  }
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

}  // namespace robosync::policy
