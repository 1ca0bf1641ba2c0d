// See convert.hpp. The columns are the keys found in the trace.
#include <cstddef>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "rsc/trace/convert.hpp"
#include "rsc/trace/trace_file.hpp"

namespace robosync::tool {
namespace {

// RFC 4180: cells with separators or quotes are quoted, and quotes inside are
// doubled.
std::string cell_of(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string cell = "\"";
  for (const char c : text) {
    if (c == '"') cell += '"';
    cell += c;
  }
  return cell + '"';
}

// In the order in which the trace first names them.
class Columns {
public:
  std::size_t of(const std::string& name) {
    const auto [found, is_new] = places_.try_emplace(name, names_.size());
    if (is_new) names_.push_back(name);
    return found->second;
  }
  const std::vector<std::string>& names() const { return names_; }

private:
  std::vector<std::string> names_;
  std::map<std::string, std::size_t> places_;
};

using Row = std::vector<std::pair<std::size_t, std::string>>;  // column and cell

void add_row(std::string& csv, const Row& row, std::size_t columns) {
  std::vector<std::string_view> cells(columns);
  for (const auto& [column, text] : row)
    cells[column] = text;
  for (std::size_t i = 0; i < columns; ++i)
    csv.append(i == 0 ? "" : ",").append(cells[i]);
  csv += "\r\n";
}

}  // namespace

std::string csv_of(const std::string& file) {
  Columns columns;
  for (const char* first : {"program", "t_us", "step", "event"})
    columns.of(first);
  std::vector<Row> rows;
  read_trace(file, [&](const TraceLine& line) {
    const std::string kind = line.text("event");
    if (kind == "image" || kind == "whole") return;  // only for rsc replay
    Row row{{0, std::to_string(line.program)}};
    for (const auto& [key, value] : line.event.items())
      row.emplace_back(columns.of(key), cell_of(line.text(key.c_str())));
    rows.push_back(std::move(row));
  });
  std::string csv;
  Row header;
  for (std::size_t i = 0; i < columns.names().size(); ++i)
    header.emplace_back(i, cell_of(columns.names()[i]));
  add_row(csv, header, columns.names().size());
  for (const Row& row : rows)
    add_row(csv, row, columns.names().size());
  return csv;
}

}  // namespace robosync::tool
