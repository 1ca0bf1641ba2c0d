// What an editor asks about a robot.json, which may be no JSON while it is typed.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/query/completion.hpp"
#include "compiler/query/describe.hpp"
#include "compiler/query/outline.hpp"
#include "compiler/source/source_file.hpp"

namespace robosync::compiler::query {

// What can be written at a place: the keys that an object lacks, and the names that a key takes. Each candidate is a text in quotes,
// and replaces what is typed with its quotes.
[[nodiscard]] Completion complete_configuration(const SourceFile& source, FileId file,
                                                std::uint32_t offset);

struct Described {
  std::string name;  // empty: there is nothing to say
  Span span;         // with its quotes
  Description about;
};
// What the string at a place means: a key, a device, a board, or the value of a key. Symbols know the names that it declares.
[[nodiscard]] Described describe_configuration(const SourceFile& source, FileId file,
                                               std::uint32_t offset, const Robot& robot);

[[nodiscard]] std::vector<OutlineItem> outline_configuration(const SourceFile& source, FileId file);

// What the schema says of the keys, as compiler/embed_keys.cmake writes it.
[[nodiscard]] std::string_view key_texts();

}  // namespace robosync::compiler::query
