// What could be written at a place: words that the grammar takes there, and names that fit.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "compiler/query/symbols.hpp"

namespace robosync::compiler::query {

struct Candidate {
  std::string text;
  std::optional<SymbolKind> kind;  // nothing: a keyword
  std::string detail;              // one line: what it is, its unit and range
  std::string text_about;          // sentences; may be empty
  bool is_text = false;            // in quotes
};

struct Completion {
  Span typed;  // what of it is there already, and is replaced
  std::vector<Candidate> candidates;
};

// In a program or a module of it.
[[nodiscard]] Completion complete(const Project& project, const Symbols& symbols, FileId file,
                                  std::uint32_t offset);

}  // namespace robosync::compiler::query
