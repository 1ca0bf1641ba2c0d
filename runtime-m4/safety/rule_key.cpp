// See rule_key.hpp.
#include "runtime-m4/safety/rule_key.hpp"

#include <cstddef>
#include <span>
#include <string_view>

#include "runtime-m4/layers/name_key.hpp"
#include "vm/opcode_traits.hpp"

namespace robosync::safety {
namespace {

constexpr unsigned kOperands = 3;

std::uint32_t add(std::uint32_t key, std::byte byte) {
  return vm::crc32(std::span(&byte, 1), key);
}

// A name ends with a zero byte, so that two names never look like one.
std::uint32_t add_name(std::uint32_t key, std::string_view name) {
  return add(layers::name_key(name, key), std::byte{0});
}

std::uint32_t add_input(std::uint32_t key, const vm::Image& image, std::size_t input) {
  if (input >= image.channels.size())
    return add_name(key, image.string(image.variables[input - image.channels.size()].name));
  const vm::Channel& channel = image.channels[input];
  key = add_name(key, image.string(image.sensors[channel.sensor].name));
  return add_name(key, image.string(channel.name));
}

std::uint32_t add_instruction(std::uint32_t key, const vm::Image& image,
                              std::span<const std::uint8_t> inputs, vm::Word word) {
  key = add(key, static_cast<std::byte>(word & 0xFF));
  for (unsigned place = 0; place < kOperands; ++place) {
    const vm::Operand kind = vm::traits_of(word).operand(place);
    if (vm::is_wide(kind)) break;
    const std::size_t cell = word >> (8 * (place + 1)) & 0xFF;
    if (vm::may_be_input(kind) && cell < inputs.size()) key = add_input(key, image, inputs[cell]);
  }
  return key;
}

}  // namespace

std::uint32_t rule_key(const vm::Image& image, const vm::Rule& rule) {
  const vm::Behavior& safety = image.behaviors[vm::kSafetyBehavior];
  const auto inputs = image.inputs.subspan(safety.first_input, safety.input_count);
  std::uint32_t key = 0;
  for (const vm::Word word : image.code.subspan(rule.condition_start, rule.condition_length))
    key = add_instruction(key, image, inputs, word);
  const std::uint32_t halted = image.responses[rule.then_response].actuators;
  for (std::size_t i = 0; i < image.actuators.size(); ++i)
    if ((halted >> i & 1) != 0) key = add_name(key, image.string(image.actuators[i].name));
  return key;
}

}  // namespace robosync::safety
