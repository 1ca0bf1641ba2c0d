// What is wrong with a text that is no JSON, in plain words: from a place and the characters around it to one E0201, with the mend
// where there is one.
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

#include "compiler/diagnostics/diagnostic.hpp"

namespace robosync::compiler::json {

struct Mistake {
  std::string_view text;
  FileId file = 0;
  std::size_t good_until = 0;     // everything before was read
  std::size_t stopped_at = 0;     // bytes the parser had read when it gave up
  std::string_view reason;        // the parser's own words
  std::optional<Span> open_span;  // the innermost object or list not yet closed
};

void report_mistake(const Mistake& mistake, Diagnostics& diagnostics);

}  // namespace robosync::compiler::json
