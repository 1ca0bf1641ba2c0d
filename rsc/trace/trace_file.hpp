// Reads traces from `rsc run --trace` and `rsc monitor --format json`: one JSON object per line.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>

#include "rsc/json.hpp"

namespace robosync::tool {

// NOLINTNEXTLINE(bugprone-exception-escape): JSON ends itself with memory of its own
struct TraceLine {
  std::size_t number = 0;   // in the file, from 1
  std::size_t program = 0;  // 1 for the first one; a monitor may see several, one after the other
  std::uint64_t at_us = 0;  // program time plus that of earlier programs: it never goes back
  Json event;

  // Empty if the event does not have it.
  [[nodiscard]] std::string text(const char* key) const;
};

// Calls `see` for each line. A line that a monitor wrote without a time has that of the previous line. An incomplete
// last line, as after a power cut, is left out with a note on stderr. Throws Failure: outside if the file cannot be
// read; program, with file and line, if it is not a trace.
void read_trace(const std::string& file, const std::function<void(const TraceLine&)>& see);

}  // namespace robosync::tool
