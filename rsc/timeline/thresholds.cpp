// See thresholds.hpp.
#include "rsc/timeline/thresholds.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include "vm/opcode.hpp"

namespace robosync::tool {
namespace {

using vm::Opcode;

constexpr std::array<std::pair<Opcode, std::string_view>, 12> kComparisons = {{
    {Opcode::lt_k, "<"},
    {Opcode::le_k, "<="},
    {Opcode::gt_k, ">"},
    {Opcode::ge_k, ">="},
    {Opcode::eq_k, "="},
    {Opcode::ne_k, "<>"},
    {Opcode::unless_lt_k, "<"},
    {Opcode::unless_le_k, "<="},
    {Opcode::unless_gt_k, ">"},
    {Opcode::unless_ge_k, ">="},
    {Opcode::unless_eq_k, "="},
    {Opcode::unless_ne_k, "<>"},
}};

struct Comparison {
  std::string_view words;
  std::size_t cell;
  vm::Value value;
};

std::optional<Comparison> comparison_at(const vm::Image& image, vm::Word word) {
  const Opcode opcode = vm::opcode_of(word);
  const auto* const found =
      std::ranges::find(kComparisons, opcode, &std::pair<Opcode, std::string_view>::first);
  if (found == kComparisons.end()) return std::nullopt;
  const bool jumps = vm::info_of(opcode).operands[1] == vm::Operand::const8;
  const std::uint8_t cell = jumps ? vm::operand_a(word) : vm::operand_b(word);
  const std::uint8_t constant = jumps ? vm::operand_b(word) : vm::operand_c(word);
  return Comparison{found->second, cell, image.constants[constant]};
}

class Collector {
public:
  explicit Collector(const vm::Image& image) : image_(image) {}

  std::vector<Threshold> all() {
    for (const vm::Behavior& behavior : image_.behaviors)
      for (std::size_t i = 0; i < behavior.rule_count; ++i)
        add_rule(behavior, behavior.first_rule + i);
    for (const vm::Check& check : image_.checks)
      for (std::size_t i = 0; i < check.band_count; ++i)
        add_band(check, i);
    return std::move(found_);
  }

private:
  void add_rule(const vm::Behavior& behavior, std::size_t number) {
    const vm::Rule& rule = image_.rules[number];
    add_code(behavior, number, rule.condition_start, rule.condition_length);
    for (const std::uint16_t index : {rule.then_response, rule.else_response}) {
      if (index == vm::kNoIndex) continue;
      const vm::Response& response = image_.responses[index];
      add_code(behavior, number, response.start, response.length);
    }
  }

  void add_code(const vm::Behavior& behavior, std::size_t rule, std::size_t start,
                std::size_t length) {
    for (const vm::Word word : image_.code.subspan(start, length)) {
      const auto comparison = comparison_at(image_, word);
      if (comparison && comparison->cell < behavior.input_count)
        add({image_.inputs[behavior.first_input + comparison->cell], comparison->words,
             comparison->value, rule});
    }
  }

  void add_band(const vm::Check& check, std::size_t number) {
    const vm::Value low = image_.bands[check.first_band + number].low;
    const vm::Variable& variable = image_.variables[check.variable];
    if (low == vm::kValueMin || number >= variable.label_count) return;
    const std::string_view name = image_.string(image_.labels[variable.first_label + number]);
    add({check.input, name, low, Threshold::kNoRule});
  }

  void add(const Threshold& one) {
    const auto same = [&](const Threshold& other) {
      return other.input == one.input && other.value == one.value && other.rule == one.rule;
    };
    if (std::ranges::none_of(found_, same)) found_.push_back(one);
  }

  const vm::Image& image_;
  std::vector<Threshold> found_;
};

}  // namespace

std::vector<Threshold> thresholds_of(const vm::Image& image) {
  return Collector(image).all();
}

}  // namespace robosync::tool
