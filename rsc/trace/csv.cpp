// Uses libcsv, one line of the file at a time, so that each row knows its line.
#include "rsc/trace/csv.hpp"

#include <algorithm>
#include <string_view>

#include <csv.h>
#include <fmt/format.h>

#include "compiler/source/utf8.hpp"
#include "rsc/failure.hpp"
#include "rsc/files.hpp"

namespace robosync::tool {
namespace {

char delimiter_of(std::string_view text) {
  const std::string_view first = text.substr(0, text.find('\n'));
  constexpr std::string_view kDelimiters = ",;\t";
  const auto used = std::ranges::find_if(
      kDelimiters, [&](char c) { return first.find(c) != std::string_view::npos; });
  return used == kDelimiters.end() ? kDelimiters.front() : *used;
}

class CsvReader {
public:
  explicit CsvReader(const std::string& file) : file_(file) {
    if (csv_init(&parser_, CSV_STRICT | CSV_STRICT_FINI) != 0) throw std::bad_alloc();
  }
  ~CsvReader() { csv_free(&parser_); }
  CsvReader(const CsvReader&) = delete;
  CsvReader& operator=(const CsvReader&) = delete;

  CsvTable read() {
    const std::string text = read_text(file_);
    std::string_view rest = compiler::utf8::without_byte_order_mark(text);
    csv_set_delim(&parser_, static_cast<unsigned char>(delimiter_of(rest)));
    while (!rest.empty()) {
      const std::size_t length = std::min(rest.find('\n'), rest.size() - 1) + 1;
      ++row_.line;
      if (csv_parse(&parser_, rest.data(), length, on_cell, on_row, this) != length) bad_quote();
      rest.remove_prefix(length);
    }
    if (csv_fini(&parser_, on_cell, on_row, this) != 0) bad_quote();
    check();
    return std::move(table_);
  }

private:
  static void on_cell(void* cell, std::size_t length, void* self) {
    static_cast<CsvReader*>(self)->row_.cells.emplace_back(static_cast<const char*>(cell), length);
  }

  static void on_row(int, void* self) {
    auto& reader = *static_cast<CsvReader*>(self);
    CsvRow& row = reader.row_;
    if (reader.table_.columns.cells.empty())
      reader.table_.columns = row;
    else
      reader.table_.rows.push_back(row);
    row.cells.clear();
  }

  [[noreturn]] void fail(std::size_t line, std::string_view message) const {
    throw Failure(Exit::program, fmt::format("{}:{}: {}", file_, line, message));
  }

  [[noreturn]] void bad_quote() const {
    fail(row_.line, "a quote is not closed, or is inside a cell; double it there");
  }

  void check() const {
    const std::size_t columns = table_.columns.cells.size();
    if (columns == 0) fail(1, "the file is empty; its first row names the columns");
    for (const CsvRow& row : table_.rows) {
      if (row.cells.size() == columns) continue;
      fail(row.line, fmt::format("this row has {} cell{}, and the first row names {} columns",
                                 row.cells.size(), row.cells.size() == 1 ? "" : "s", columns));
    }
  }

  const std::string& file_;
  csv_parser parser_{};
  CsvRow row_;  // the current row
  CsvTable table_;
};

}  // namespace

CsvTable read_csv(const std::string& file) {
  return CsvReader(file).read();
}

}  // namespace robosync::tool
