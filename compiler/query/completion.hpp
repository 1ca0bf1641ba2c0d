// What can be written at a place: keywords that the grammar accepts there, and names that fit.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "compiler/query/symbols.hpp"

namespace robosync::compiler::query {

struct Candidate {
  std::string text;
  std::optional<SymbolKind> kind;  // nullopt: a keyword
  std::string detail;              // one line: what it is, its unit and range
  std::string text_about;          // sentences; may be empty
  bool is_text = false;            // in quotes
};

struct Completion {
  Span typed;  // the part that is already typed, which is replaced
  std::vector<Candidate> candidates;
};

// `file`: a program, or one of its modules.
[[nodiscard]] Completion complete(const Project& project, const Symbols& symbols, FileId file,
                                  std::uint32_t offset);

}  // namespace robosync::compiler::query
