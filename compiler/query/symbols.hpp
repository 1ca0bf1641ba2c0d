// What every name in a program, its modules and its robot.json means, and where else it stands. Names are looked up as
// analyze() does (sema/names.hpp); what is wrong with them is for analyze() to say.
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
  std::string name;  // as it is declared
  // Where it is declared, or what brought it along: of a verb, an actuator that knows it. Nothing: it is part of RSL.
  std::optional<Span> declared;
  bool is_there = true;  // the name itself stands at `declared`
  // Of what robot.json declares: its place in the robot; of a channel, in its sensor.
  std::size_t owner = 0, place = 0;
  // Of a label: the name that it is one of. Of a name in a BEHAVIOR or DEFINE: that.
  std::string within{};
};

struct Occurrence {
  Span span;
  std::size_t symbol = 0;  // its place in Symbols::all()
  bool declares = false;
};

class Symbols {
public:
  explicit Symbols(const Project& project);

  [[nodiscard]] const std::vector<Symbol>& all() const { return symbols_; }
  // In the order of the files and of their text.
  [[nodiscard]] const std::vector<Occurrence>& occurrences() const { return occurrences_; }
  // The name that the offset is in, or at whose end it is; nullptr: none.
  [[nodiscard]] const Occurrence* at(FileId file, std::uint32_t offset) const;
  [[nodiscard]] std::vector<Occurrence> of(std::size_t symbol) const;

private:
  std::vector<Symbol> symbols_;
  std::vector<Occurrence> occurrences_;
};

}  // namespace robosync::compiler::query
