// See convert.hpp.
#include <algorithm>
#include <cstddef>
#include <string>
#include <string_view>

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

constexpr std::string_view kEach =
#define COLUMNS(names, doc) names ","
#include "rsc/json.hpp"
#include "rsc/trace/csv_columns.def"
#undef COLUMNS
    ;
constexpr std::string_view kColumns = kEach.substr(0, kEach.size() - 1);
constexpr auto kCommas = static_cast<std::size_t>(std::ranges::count(kColumns, ','));

// The cells of `line` in the order of the columns, with commas between them.
std::string row_of(const TraceLine& line) {
  Json more = line.event;
  std::string row = std::to_string(line.program);
  std::string_view rest = kColumns;
  for (std::size_t i = 1; i < kCommas; ++i) {
    rest.remove_prefix(rest.find(',') + 1);
    const std::string key(rest.substr(0, rest.find(',')));
    row += ',' + cell_of(line.text(key.c_str()));
    more.erase(key);
  }
  row += ',';
  if (!more.empty()) row += cell_of(json_text(more));
  return row;
}

}  // namespace

std::string csv_of(const std::string& file) {
  constexpr std::string_view kEnd = "\r\n";
  std::string csv(kColumns);
  csv += kEnd;
  read_trace(file, [&](const TraceLine& line) {
    const std::string kind = line.text("event");
    if (kind == "image" || kind == "whole") return;  // only for rsc replay
    csv.append(row_of(line)).append(kEnd);
  });
  return csv;
}

}  // namespace robosync::tool
