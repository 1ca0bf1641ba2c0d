// The meaning of every name in a program, its modules and its robot.json, and where else it occurs. Names are resolved as
// analyze() does (sema/names.hpp); analyze() reports mistakes in them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "compiler/query/project.hpp"

namespace robosync::compiler::query {

enum class SymbolKind : std::uint8_t {
#define SYMBOL_KIND(name, said) name,
#include "compiler/query/symbol_kinds.def"
#undef SYMBOL_KIND
};

struct Symbol {
  SymbolKind kind{};
  std::string name;  // as declared
  // Its declaration, or the entry that it comes from: for a verb, an actuator that knows it. nullopt: it is part of RSL.
  std::optional<Span> declared;
  bool is_there = true;  // the name itself is at `declared`
  // For symbols from robot.json: `owner` is the index in the robot. For a channel, `owner` is the index of its sensor, and
  // `place` the index in that sensor.
  std::size_t owner = 0, place = 0;
  // For a label: the name that it belongs to. For a name in a BEHAVIOR or DEFINE: the name of that.
  std::string within{};
};

struct Occurrence {
  Span span;
  std::size_t symbol = 0;  // its index in Symbols::all()
  bool declares = false;
};

class Symbols {
public:
  explicit Symbols(const Project& project);

  [[nodiscard]] const std::vector<Symbol>& all() const { return symbols_; }
  // Ordered by file and by place in the text.
  [[nodiscard]] const std::vector<Occurrence>& occurrences() const { return occurrences_; }
  // The name that contains the offset, or ends at it; nullptr: none.
  [[nodiscard]] const Occurrence* at(FileId file, std::uint32_t offset) const;
  [[nodiscard]] std::vector<Occurrence> of(std::size_t symbol) const;

private:
  std::vector<Symbol> symbols_;
  std::vector<Occurrence> occurrences_;
};

}  // namespace robosync::compiler::query
