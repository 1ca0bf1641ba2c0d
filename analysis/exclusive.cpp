// See exclusive.hpp. Conditions have no jumps, so one pass from the first word to the last tracks
// what must hold if each cell is true.
#include "analysis/exclusive.hpp"

#include <algorithm>

#include "vm/opcode.hpp"

namespace robosync::analysis {
namespace {

using vm::Opcode;

Needs both(const Needs& a, const Needs& b) {
  Needs needs = a;
  for (const auto& [input, range] : b) {
    Range& mine = needs[input];
    mine = {std::max(mine.least, range.least), std::min(mine.most, range.most)};
  }
  return needs;
}

Needs either(const Needs& a, const Needs& b) {
  Needs needs;
  for (const auto& [input, range] : a) {
    const auto other = b.find(input);
    if (other == b.end()) continue;
    needs[input] = {std::min(range.least, other->second.least),
                    std::max(range.most, other->second.most)};
  }
  return needs;
}

Range compared(Opcode op, vm::Value number) {
  switch (op) {
    case Opcode::lt_k:
      return {vm::kValueMin, number - 1};
    case Opcode::le_k:
      return {vm::kValueMin, number};
    case Opcode::gt_k:
      return {number == vm::kValueMax ? number : number + 1, vm::kValueMax};
    case Opcode::ge_k:
      return {number, vm::kValueMax};
    case Opcode::eq_k:
      return {number, number};
    default:
      return {};
  }
}

class ConditionReader {
public:
  ConditionReader(const vm::Image& image, const vm::Behavior& behavior)
      : image_(image), behavior_(behavior) {}

  Needs read(std::span<const vm::Word> condition) {
    for (const vm::Word word : condition) {
      const Opcode op = vm::opcode_of(word);
      if (op == Opcode::ret) return cells_[vm::operand_a(word)];
      cells_[vm::operand_a(word)] = result_of(op, word);
    }
    return {};
  }

private:
  Needs result_of(Opcode op, vm::Word word) {
    const std::uint8_t a = vm::operand_a(word);
    const std::uint8_t b = vm::operand_b(word);
    const std::uint8_t c = vm::operand_c(word);
    switch (op) {
      case Opcode::lt_k:
      case Opcode::le_k:
      case Opcode::gt_k:
      case Opcode::ge_k:
      case Opcode::eq_k:
        if (b >= behavior_.input_count) return {};
        return {{image_.inputs[behavior_.first_input + b], compared(op, image_.constants[c])}};
      case Opcode::and_:
        return both(cells_[b], cells_[c]);
      case Opcode::or_:
        return either(cells_[b], cells_[c]);
      case Opcode::latch:
        return either(cells_[a], cells_[b]);
      case Opcode::move:
      case Opcode::held:
      case Opcode::counted:
      case Opcode::sequence:
      case Opcode::rose:
        return cells_[b];  // true only while B is
      default:
        return {};
    }
  }

  const vm::Image& image_;
  const vm::Behavior& behavior_;
  std::map<std::uint8_t, Needs> cells_;
};

}  // namespace

Needs needs_of(const vm::Image& image, const vm::Behavior& behavior, const vm::Rule& rule) {
  if (rule.kind != vm::RuleKind::when && rule.kind != vm::RuleKind::while_) return {};
  return ConditionReader(image, behavior)
      .read(image.code.subspan(rule.condition_start, rule.condition_length));
}

bool exclude_each_other(const Needs& a, const Needs& b) {
  return std::ranges::any_of(a, [&](const auto& need) {
    const auto other = b.find(need.first);
    return other != b.end() &&
           (need.second.most < other->second.least || other->second.most < need.second.least);
  });
}

}  // namespace robosync::analysis
