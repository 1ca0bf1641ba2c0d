#include "compiler/codegen/code.hpp"

#include <algorithm>
#include <iterator>

#include "compiler/codegen/operations.hpp"

namespace robosync::compiler {
namespace {

constexpr std::size_t kShortReach = 255;  // words that a jump with two operands can skip

}  // namespace

void CodeDraft::mark(const Source& source) {
  if (!marks_.empty() && marks_.back().at == size()) marks_.pop_back();
  if (marks_.empty() || marks_.back().source.line != source.line)
    marks_.push_back({size(), source});
}

void CodeDraft::land(std::size_t from) {
  const bool compares = compared_by(instructions_[from].opcode).has_value();
  if (compares && size() - from - 1 <= kShortReach) {
    instructions_[from].operands[2] = distance(from + 1, size());
    return;
  }
  if (compares) split(from++);
  instructions_[from].operands[1] = distance(from + 1, size());
}

// ExpressionEmitter::jump_unless() reserves register 0 for the truth value.
void CodeDraft::split(std::size_t from) {
  const Cell truth{Zone::temporary, 0};
  Instruction& compare = instructions_[from];
  compare.opcode = *compared_by(compare.opcode);
  compare.operands = {truth, compare.operands[0], compare.operands[1]};
  const auto behind = instructions_.begin() + static_cast<std::ptrdiff_t>(from) + 1;
  instructions_.insert(behind, {vm::Opcode::unless, {truth}});
  for (Mark& mark : marks_)
    if (mark.at > from) ++mark.at;
}

// ---- frames

Cell Frame::read(std::uint32_t input) {
  read_.insert(input);
  return {Zone::input, input};
}

Cell Frame::write(std::uint32_t input) {
  written_.insert(input);
  return read(input);
}

Cell Frame::add_local() {
  return {Zone::local, locals_++};
}

Cell Frame::add_watch() {
  return {Zone::watch, watches_++};
}

Cell Frame::temporary(std::uint32_t depth) {
  temporaries_ = std::max(temporaries_, depth + 1);
  return {Zone::temporary, depth};
}

std::vector<std::uint32_t> Frame::inputs() const {
  std::vector<std::uint32_t> inputs(written_.begin(), written_.end());
  std::set_difference(read_.begin(), read_.end(), written_.begin(), written_.end(),
                      std::back_inserter(inputs));
  return inputs;
}

std::size_t Frame::cells() const {
  return read_.size() + locals_ + watches_ + temporaries_;
}

CodeObject Frame::resolve(const CodeDraft& code) const {
  const std::vector<std::uint32_t> order = inputs();
  const auto locals = static_cast<std::uint32_t>(order.size());
  const auto place = [&](const Operand& operand) -> std::uint32_t {
    if (!operand.zone) return operand.value;
    switch (*operand.zone) {
      case Zone::input:
        return static_cast<std::uint32_t>(std::find(order.begin(), order.end(), operand.value) -
                                          order.begin());
      case Zone::local:
        return locals + operand.value;
      case Zone::watch:
        return locals + locals_ + operand.value;
      case Zone::temporary:
        break;
    }
    return locals + locals_ + watches_ + operand.value;
  };
  CodeObject object;
  object.words.reserve(code.size());
  for (const Instruction& instruction : code.instructions()) {
    const auto& [a, b, c] = instruction.operands;
    object.words.push_back(vm::encode(instruction.opcode, place(a), place(b), place(c)));
  }
  object.marks = code.marks();
  return object;
}

// ---- the code section

std::size_t CodePool::constant(vm::Value value) {
  const auto [place, added] = constant_places_.emplace(value, constants_.size());
  if (added) constants_.push_back(value);
  return place->second;
}

std::optional<std::uint32_t> CodePool::near_constant(vm::Value value) {
  const auto known = constant_places_.find(value);
  const bool near =
      known == constant_places_.end() ? constants_.size() < kMaxConst8 : known->second < kMaxConst8;
  if (!near) return std::nullopt;
  return static_cast<std::uint32_t>(constant(value));
}

std::size_t CodePool::add(const CodeObject& object) {
  const auto [place, added] = object_places_.emplace(object.words, code_.size());
  if (!added) return place->second;
  for (const Mark& mark : object.marks)
    marks_.push_back({code_.size() + mark.at, mark.source});
  code_.insert(code_.end(), object.words.begin(), object.words.end());
  return place->second;
}

std::vector<vm::SourceLine> CodePool::lines() const {
  std::vector<vm::SourceLine> lines;
  lines.reserve(marks_.size());
  for (const Mark& mark : marks_)
    lines.push_back({static_cast<std::uint16_t>(mark.at), mark.source.line});
  return lines;
}

Span CodePool::span_of(std::size_t word) const {
  const auto after =
      std::upper_bound(marks_.begin(), marks_.end(), word,
                       [](std::size_t at, const Mark& mark) { return at < mark.at; });
  return after == marks_.begin() ? Span{} : std::prev(after)->source.span;
}

}  // namespace robosync::compiler
