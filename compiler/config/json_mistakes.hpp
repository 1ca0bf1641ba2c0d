// Explains in plain words what is wrong with text that is not JSON. Reports one E0201 from the place and the characters around
// it, with a suggested fix if there is one.
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

#include "compiler/diagnostics/diagnostic.hpp"

namespace robosync::compiler::json {

struct Mistake {
  std::string_view text;
  FileId file = 0;
  std::size_t good_until = 0;     // everything before it was read
  std::size_t stopped_at = 0;     // bytes that the parser had consumed when it gave up
  std::string_view reason;        // the parser's own message
  std::optional<Span> open_span;  // the innermost object or list not yet closed
};

void report_mistake(const Mistake& mistake, Diagnostics& diagnostics);

}  // namespace robosync::compiler::json
