// What can be written at a place of a robot.json: the keys that an object lacks, and the names that a key takes.
#pragma once

#include <cstdint>

#include "compiler/query/completion.hpp"
#include "compiler/source/source_file.hpp"

namespace robosync::compiler::query {

// Each candidate is a text in quotes, and replaces what is typed with its quotes.
[[nodiscard]] Completion complete_configuration(const SourceFile& source, FileId file,
                                                std::uint32_t offset);

}  // namespace robosync::compiler::query
