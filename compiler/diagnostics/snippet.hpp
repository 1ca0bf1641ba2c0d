// One line of source with a marker line under it, as it looks on a terminal: tabs are expanded, code
// points counted by display width, and long lines cut around the marked place.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace robosync::compiler {

struct Snippet {
  std::string source;
  std::string marker;  // spaces, then `mark` under each column of the span
};

// Marks the bytes begin … end-1 of `line`; an empty or backward range marks one column.
[[nodiscard]] Snippet make_snippet(std::string_view line, std::size_t begin, std::size_t end,
                                   char mark);

}  // namespace robosync::compiler
