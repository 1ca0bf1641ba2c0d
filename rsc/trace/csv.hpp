// CSV files (RFC 4180), read whole: the first row names the columns.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace robosync::tool {

struct CsvRow {
  std::size_t line = 0;            // where it ends in the file, from 1
  std::vector<std::string> cells;  // as many as the table has columns
};

struct CsvTable {
  CsvRow columns;
  std::vector<CsvRow> rows;
};

// Columns stand between commas, semicolons or tabs, whichever the first row has. Empty rows are
// left out. Throws Failure: outside when the file cannot be read; program, with file and line, when
// it has no columns, a quote without its end, or a row of another length.
[[nodiscard]] CsvTable read_csv(const std::string& file);

}  // namespace robosync::tool
