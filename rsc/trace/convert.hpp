// Converts traces to the formats of other tools. Each reads the file with read_trace(), and throws what that
// throws.
#pragma once

#include <string>

namespace robosync::tool {

// JSON for https://ui.perfetto.dev and chrome://tracing.
[[nodiscard]] std::string perfetto_of(const std::string& file);
// A row for each line of the trace; the columns are the same for every trace.
[[nodiscard]] std::string csv_of(const std::string& file);
// Value change dump (IEEE 1364), with GTKWave's variables for words.
[[nodiscard]] std::string vcd_of(const std::string& file);

}  // namespace robosync::tool
