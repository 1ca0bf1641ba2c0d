#include "compiler/codegen/code_pool.hpp"

#include <algorithm>

namespace robosync::compiler {

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
