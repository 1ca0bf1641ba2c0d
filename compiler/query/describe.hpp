// Describes a name in words, for hovers and completions.
#pragma once

#include <string>

#include "compiler/query/symbols.hpp"

namespace robosync::compiler::query {

struct Description {
  std::string kind;  // "a channel of touch": one line
  std::string code;  // the declaration in RSL; empty if there is none to show
  std::string text;  // plain sentences, a line each; may be empty
};

[[nodiscard]] Description describe(const Symbol& symbol, const Project& project);

// Describes a verb or a word as this actuator defines it.
[[nodiscard]] std::string describe_verb(const ActuatorConfig& actuator, const VerbConfig& verb);
[[nodiscard]] std::string describe_word(const ActuatorConfig& actuator, const WordConfig& word);

// "from 2cm to 400cm. It is read every 60 ms."
[[nodiscard]] std::string describe_channel(const ChannelConfig& channel);
// Its verbs and its limits: a line each, which begins with its end of line.
[[nodiscard]] std::string describe_actuator(const ActuatorConfig& actuator);

// The comment directly above the line of `offset`, without its comment signs.
[[nodiscard]] std::string comment_above(const SourceFile& source, std::uint32_t offset);

// What a rule does, if the place is in its first line; otherwise empty.
[[nodiscard]] std::string rule_in_english(const Project& project, FileId file,
                                          std::uint32_t offset);

}  // namespace robosync::compiler::query
