// Reads whole CSV files (RFC 4180): the first row names the columns.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace robosync::tool {

struct CsvRow {
  std::size_t line = 0;            // the line of the file on which it ends, from 1
  std::vector<std::string> cells;  // as many as the table has columns
};

struct CsvTable {
  CsvRow columns;
  std::vector<CsvRow> rows;
};

// Columns are separated by commas, semicolons or tabs, whichever the first row uses. Empty rows are
// skipped. Throws Failure: outside if the file cannot be read; program, with file and line, if it
// has no columns, an unclosed quote, or a row of another length.
[[nodiscard]] CsvTable read_csv(const std::string& file);

}  // namespace robosync::tool
