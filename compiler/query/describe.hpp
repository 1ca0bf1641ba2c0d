// What a name is, in words for a person: shown where the mouse rests, and beside a completion.
#pragma once

#include <string>

#include "compiler/query/symbols.hpp"

namespace robosync::compiler::query {

struct Description {
  std::string kind;  // "a channel of touch": one line
  std::string code;  // how it is declared, in RSL; empty where that says nothing
  std::string text;  // plain sentences, a line each; may be empty
};

[[nodiscard]] Description describe(const Symbol& symbol, const Project& project);

// Of a verb or a word as one actuator knows it.
[[nodiscard]] std::string describe_verb(const ActuatorConfig& actuator, const VerbConfig& verb);
[[nodiscard]] std::string describe_word(const ActuatorConfig& actuator, const WordConfig& word);

// The comment that stands right above the line of a place, without its signs.
[[nodiscard]] std::string comment_above(const SourceFile& source, std::uint32_t offset);

// What a rule does, if the place is in its first line; else empty.
[[nodiscard]] std::string rule_in_english(const Project& project, FileId file,
                                          std::uint32_t offset);

}  // namespace robosync::compiler::query
